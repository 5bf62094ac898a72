// The textures of shaders/, from the head's record.

import {
  ClampToEdgeWrapping, Data3DTexture, DataTexture, DepthTexture, FloatType, LessEqualCompare, LinearFilter, LinearMipmapLinearFilter,
  NearestFilter, RGBAFormat, RepeatWrapping, SRGBColorSpace, Texture, UnsignedByteType, UnsignedIntType, WebGLRenderTarget,
} from 'three';

const SHADOW_SIDE = 112;
export const COLUMNS = 256;

/** A tiling volume of four bytes a texel. */
export function volumeOf(bytes) {
  const [depth, height, width] = bytes.shape;
  const texture = new Data3DTexture(bytes, width, height, depth);
  texture.format = RGBAFormat;
  texture.type = UnsignedByteType;
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.wrapS = texture.wrapT = texture.wrapR = RepeatWrapping;
  texture.needsUpdate = true;
  return texture;
}

/** The atlas of wrinkles, `texels` of `side` times `side`. */
export function atlasTexture(texels, side) {
  const texture = new DataTexture(texels, side, side, RGBAFormat, UnsignedByteType);
  texture.minFilter = texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

/** Places of `count` vertices of skin in the upper half of its rows, normals in the lower: shaders/surface.glsl. */
export function skinTexture(count) {
  const rows = Math.ceil(count / COLUMNS);
  const texture = new DataTexture(new Float32Array(4 * COLUMNS * 2 * rows), COLUMNS, 2 * rows, RGBAFormat, FloatType);
  texture.minFilter = texture.magFilter = NearestFilter;
  texture.needsUpdate = true;
  return texture;
}

/** The key light's picture of depths. */
export function shadowTarget() {
  const depthTexture = new DepthTexture(SHADOW_SIDE, SHADOW_SIDE, UnsignedIntType);
  depthTexture.compareFunction = LessEqualCompare;
  depthTexture.minFilter = depthTexture.magFilter = LinearFilter;
  return new WebGLRenderTarget(SHADOW_SIDE, SHADOW_SIDE, { depthTexture });
}

/** The picture that the skin wears, of the bytes of a PNG file. */
export async function pictureTexture(bytes) {
  const options = { premultiplyAlpha: 'none', colorSpaceConversion: 'none' };
  const image = await createImageBitmap(new Blob([bytes], { type: 'image/png' }), options);
  const texture = new Texture(image);
  texture.flipY = false;
  texture.colorSpace = SRGBColorSpace;
  texture.wrapS = texture.wrapT = ClampToEdgeWrapping;
  texture.minFilter = LinearMipmapLinearFilter;
  texture.needsUpdate = true;
  return texture;
}
