// The face as an object of a three.js scene.

import { Camera, Matrix4, Object3D, Scene, Uniform, UniformsGroup, Vector2, Vector3 } from 'three';
import { WrinkleAtlas } from './atlas.js';
import { readHead } from './glb.js';
import { FineLips } from './lips.js';
import { Materials, drawn, geometryOf, partOf, skinGeometry } from './meshes.js';
import { lidUniforms, mouthUniforms } from './openings.js';
import { breathing, frameAtRest, matrixOf, product } from './rigid.js';
import { Skin, moveBy, writeNormals } from './skin.js';
import { COLUMNS, atlasTexture, pictureTexture, shadowTarget, skinTexture, volumeOf } from './textures.js';

const BLOCK = { view: 0, shadow: 16, head: 32, eye: 48, direction: 52, colour: 68, sky: 84, ground: 88, length: 92 };
const [FIRST, SHEETS, STRANDS, CAP, SKIN, INSIDE, PARTS, BROWS, LASHES, CAP_EDGE, HAIRS] = Array.from({ length: 11 }, (_, i) => i + 1);
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/**
 * A face in metres, looking along +Z, the middle of its head near the origin. Add it to a scene, give it frames with
 * `show(frame)`; it is lit by the lights of its own look. Its shaders give sRGB: draw to the screen, not into a linear target.
 */
export class Face3D extends Object3D {
  /** The face in the file at `url`. */
  static async load(url, options) {
    const response = await fetch(url, options);
    if (!response.ok) throw new Error(`${url}: expected the head, got ${response.status} ${response.statusText}`);
    return Face3D.read(await response.arrayBuffer());
  }

  /** The face in the bytes of a head's file. */
  static async read(buffer) {
    const head = readHead(buffer);
    return new Face3D(head, head.picture && (await pictureTexture(head.picture)));
  }

  constructor(head, picture = null) {
    super();
    this.name = head.face;
    this.head = head;
    this.views = head.views;
    this.skin = new Skin(head);
    this.lips = new FineLips(head.lips, head.rest.vertices);
    this.wrinkles = new WrinkleAtlas(head.atlas);
    this.fields = skinTexture(this.skin.count + this.lips.count);
    this.atlas = atlasTexture(this.wrinkles.texels, head.atlas.side);
    this.shadow = shadowTarget();
    this.textures = [volumeOf(head.noise), volumeOf(head.pores), this.fields, this.atlas, ...(picture ? [picture] : [])];
    this.block = new Float32Array(BLOCK.length);
    this.frame = new UniformsGroup();
    this.frame.setName('Frame');
    this.frame.add(new Uniform(this.block));
    this.common = {};
    for (const [name, value] of Object.entries(head.uniforms)) this.common[name] = { value };
    this.set({
      skin_fields: this.fields, noise_volume: this.textures[0], pores: this.textures[1], wrinkle_atlas: this.atlas,
      key_depth: this.shadow.depthTexture, skin_picture: picture, ...mouthUniforms(head.mouth, head.rest.vertices),
    });
    this.materials = new Materials(head.programs, this.common, this.frame);
    this.light();
    this.build();
    this.shown = null;
    this.stale = true;
    this.show(frameAtRest(head));
  }

  /** Give uniforms of all programs their values. */
  set(values) {
    for (const [name, value] of Object.entries(values)) (this.common[name] ??= {}).value = value;
  }

  light() {
    const { direction, colour, sky, ground, shadow } = this.head.lights;
    this.block.set(new Matrix4().fromArray(shadow).transpose().elements, BLOCK.shadow);
    this.block.set(direction, BLOCK.direction);
    this.block.set(colour, BLOCK.colour);
    this.block.set(sky, BLOCK.sky);
    this.block.set(ground, BLOCK.ground);
  }

  build() {
    const { head, materials } = this;
    const nothing = { fields: { ends: Object.assign(new Int32Array(2), { shape: [1, 2] }) }, triangles: new Uint16Array(0) };
    const first = drawn(geometryOf(nothing), materials.solid('depth'), FIRST);
    first.onBeforeRender = (renderer, _, camera) => this.prepare(renderer, camera);
    this.add(first);
    if (head.hair) this.buildHair();
    this.skinMaterials = [materials.solid('skin'), materials.solid('skin-wrinkled')];
    this.skinMesh = drawn(skinGeometry(head.skin), this.skinMaterials[0], SKIN);
    this.add(this.skinMesh);
    this.buildParts();
    for (const [name, order] of [['brows', BROWS], ['lashes', LASHES]]) {
      this.add(drawn(geometryOf(head[name]), materials.soft('ribbon', { gloss: head[name].gloss }), order));
    }
    const { vertices, triangles } = head.rest;
    const ends = Int32Array.from({ length: 2 * (vertices.length / 3) }, (_, i) => i >> 1);
    const outline = geometryOf({ fields: { ends: Object.assign(ends, { shape: [ends.length / 2, 2] }) }, triangles });
    this.shadowScene = new Scene();
    this.shadowScene.add(drawn(outline, materials.solid('depth', {}, 'both'), 0));
    this.shadowCamera = new Camera();
  }

  buildHair() {
    const { materials } = this, { cap, strands, sheets, centre } = this.head.hair;
    if (sheets) {
      const geometry = geometryOf(sheets), own = { least_cover: sheets.least_cover };
      this.add(drawn(geometry, materials.hairy('sheet', own, 'outer'), SHEETS));
      this.add(drawn(partOf(geometry, 0, sheets.hanging), materials.hairy('sheet', own, 'inner'), INSIDE));
    }
    const geometry = geometryOf(strands);
    const own = { hair_centre: [...centre], lift: strands.lift, narrowest: strands.narrowest, streaks: strands.streaks };
    this.add(drawn(partOf(geometry, 0, strands.solid), materials.solid('strand', { ...own, solid: 1 }, 'both'), STRANDS));
    this.add(drawn(partOf(geometry, strands.solid), materials.soft('strand', { ...own, solid: 0 }, 'both', { depthWrite: false }), HAIRS));
    const layer = geometryOf(cap), worn = { coils: cap.coils, parting: cap.parting };
    this.add(drawn(partOf(layer, 0, cap.solid), materials.solid('cap', worn), CAP));
    this.add(drawn(partOf(layer, cap.solid), materials.soft('cap', worn, 'outer'), CAP_EDGE));
  }

  buildParts() {
    const { head, materials } = this;
    const part = (record, program, own) => {
      const mesh = drawn(geometryOf(record), materials.solid(program, own), PARTS);
      this.add(mesh);
      return mesh;
    };
    this.parts = Object.fromEntries(Object.entries(head.parts).map(([name, record]) => {
      const shaded = name === 'teeth_upper' ? 0 : head.mouth.shaded;
      return [name, part(record, 'part', { moved: IDENTITY, shaded })];
    }));
    this.shirt = part(head.shirt, 'cloth', { moved: IDENTITY });
    for (const lining of head.linings) part(lining, 'lining', {});
    this.eyes = head.eyes.map((eye) => part(eye, 'eye', {
      turned: IDENTITY, centre: [0, 0, 0], radius: eye.radius, upper_lid: [0, 0, 0], lower_lid: [0, 0, 0], corners: [0, 0], dilation: 1,
    }));
    const tongue = head.parts.tongue;
    this.tongue = { rest: Float32Array.from(tongue.fields.place), sums: new Float64Array(tongue.fields.place.length) };
  }

  /** Show a frame: what `FrameReader.read` gives. */
  show(frame) {
    this.skin.update(frame);
    this.lips.update(this.skin.vertices, this.skin.normals);
    this.writeSkin();
    if (this.wrinkles.update(frame.wrinkle_levels ?? [])) this.atlas.needsUpdate = true;
    this.skinMesh.material = this.skinMaterials[Number(this.wrinkles.risen)];
    const head = matrixOf(frame.head), jaw = product(head, matrixOf(frame.jaw));
    this.block.set(head, BLOCK.head);
    this.set(mouthUniforms(this.head.mouth, this.skin.vertices));
    this.moveTongue(frame);
    this.parts.teeth_upper.material.uniforms.moved.value = head;
    this.parts.teeth_lower.material.uniforms.moved.value = jaw;
    this.parts.tongue.material.uniforms.moved.value = jaw;
    this.shirt.material.uniforms.moved.value = breathing(this.head.shirt.breathing, frame.breath);
    this.eyes.forEach((mesh, side) => this.turnEye(mesh, side, frame, head));
    this.shown = frame;
    this.stale = true;
  }

  writeSkin() {
    const texels = this.fields.image.data, lower = texels.length / 2;
    const put = (rows, offset, start) => {
      for (let i = 0, at = offset + 4 * start; i < rows.length; i += 3, at += 4) {
        texels[at] = rows[i]; texels[at + 1] = rows[i + 1]; texels[at + 2] = rows[i + 2];
      }
    };
    put(this.skin.vertices, 0, 0);
    put(this.skin.normals, lower, 0);
    put(this.lips.places, 0, this.skin.count);
    put(this.lips.normals, lower, this.skin.count);
    for (let i = 0; i < this.skin.count; i++) texels[4 * i + 3] = this.skin.heights[i];
    this.fields.needsUpdate = true;
  }

  moveTongue(frame) {
    const { place, facing } = this.parts.tongue.geometry.attributes, { rest, sums } = this.tongue;
    if (frame.tongue_vertices) for (let i = 0; i < rest.length; i++) place.array[i] = rest[i] + frame.tongue_vertices[i];
    else moveBy(place.array, rest, this.head.basis.tongue, frame.tongue);
    writeNormals(place.array, this.parts.tongue.geometry.index.array, sums, facing.array);
    place.needsUpdate = facing.needsUpdate = true;
  }

  turnEye(mesh, side, frame, head) {
    const eye = this.head.eyes[side], { uniforms } = mesh.material;
    const centre = [eye.centre[0], eye.centre[1], eye.centre[2] + frame.eye_thrust[side]];
    const turned = product(head, matrixOf([...frame.eyes.slice(4 * side, 4 * side + 4), ...centre], eye.radius));
    for (const [name, value] of Object.entries(lidUniforms(eye, centre, this.skin.vertices))) uniforms[name].value = value;
    uniforms.turned.value = turned;
    uniforms.centre.value = turned.slice(12, 15);
    uniforms.dilation.value = frame.pupils[side];
  }

  /** What all programs share in the picture that `renderer` begins for `camera`, and the key light's shadow. */
  prepare(renderer, camera) {
    const view = new Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).multiply(this.matrixWorld);
    const eye = new Vector3().setFromMatrixPosition(camera.matrixWorld).applyMatrix4(new Matrix4().copy(this.matrixWorld).invert());
    const target = renderer.getRenderTarget();
    const height = target ? target.height : renderer.getDrawingBufferSize(new Vector2()).y;
    this.block.set(view.elements, BLOCK.view);
    this.block.set([eye.x, eye.y, eye.z, 0.5 * height * camera.projectionMatrix.elements[5]], BLOCK.eye);
    if (!this.stale) return;
    this.stale = false;
    const { autoClear } = renderer, xr = renderer.xr.enabled;
    renderer.xr.enabled = false;
    renderer.autoClear = true;
    renderer.setRenderTarget(this.shadow);
    renderer.render(this.shadowScene, this.shadowCamera);
    renderer.setRenderTarget(target);
    renderer.autoClear = autoClear;
    renderer.xr.enabled = xr;
  }

  /** Give back what the GPU holds. */
  dispose() {
    for (const mesh of [...this.children, ...this.shadowScene.children]) mesh.geometry?.dispose();
    for (const texture of this.textures) texture.dispose();
    this.shadow.dispose();
    this.materials.dispose();
    this.frame.dispose();
  }
}
