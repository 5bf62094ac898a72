// A canvas with a face before its background, or before nothing.

import {
  BufferAttribute, BufferGeometry, CustomBlending, GreaterDepth, OneFactor, Scene, ShaderMaterial, WebGLRenderer, ZeroFactor,
} from 'three';
import { Materials, drawn } from './meshes.js';
import { PortraitCamera, viewNamed } from './views.js';

const BEHIND = -1, COVERED = 8.5;
const MOST_PIXELS = { portrait: 2, fast: 1 };

/** Draws one face on `canvas`. */
export class Stage {
  /** `quality`: `portrait`, several samples a pixel, or `fast`; `transparent`: with nothing behind the face. */
  constructor(canvas, { quality = 'portrait', transparent = false, keep = false } = {}) {
    this.quality = MOST_PIXELS[quality] ? quality : 'portrait';
    this.transparent = transparent;
    this.renderer = new WebGLRenderer({
      canvas, alpha: transparent, antialias: this.quality === 'portrait', premultipliedAlpha: true, preserveDrawingBuffer: keep,
    });
    this.renderer.setClearColor(0x000000, 0);
    this.scene = new Scene();
    this.camera = new PortraitCamera();
    this.view = 'front';
    this.face = null;
    this.size = [1, 1];
  }

  /** Show another face; the one before is given back. */
  show(face) {
    this.clear();
    this.face = face;
    this.scene.add(face, this.transparent ? covered() : this.background(face));
    this.look(this.view);
  }

  /** Stand at the view of this name. */
  look(view) {
    this.view = view;
    if (this.face) this.camera.stand(viewNamed(this.face.views, view));
  }

  background(face) {
    this.materials = new Materials(face.head.programs, face.common, face.frame);
    const material = this.materials.material('background', { aspect: 1 }, { depthTest: false, depthWrite: false });
    this.backdrop = drawn(screen(), material, BEHIND);
    return this.backdrop;
  }

  /** Take in a canvas of `width` times `height` CSS pixels. */
  resize(width, height, ratio = globalThis.devicePixelRatio || 1) {
    this.size = [Math.max(width, 1), Math.max(height, 1)];
    this.renderer.setPixelRatio(Math.min(ratio, MOST_PIXELS[this.quality]));
    this.renderer.setSize(...this.size, false);
  }

  /** Draw what is shown. */
  draw() {
    if (!this.face) return;
    const aspect = this.size[0] / this.size[1];
    this.camera.frameFor(aspect);
    if (this.backdrop) this.backdrop.material.uniforms.aspect.value = aspect;
    this.renderer.render(this.scene, this.camera);
  }

  clear() {
    this.scene.clear();
    this.face?.dispose();
    this.materials?.dispose();
    this.face = this.backdrop = this.materials = null;
  }

  dispose() {
    this.clear();
    this.renderer.dispose();
  }
}

// three corners that cover the screen: shaders/screen.vert.glsl makes them of their numbers
function screen() {
  return new BufferGeometry().setAttribute('position', new BufferAttribute(new Float32Array(9), 3));
}

// Hair leaves the opacity as it is; where something solid is nearer than the farthest, the picture is opaque.
function covered() {
  const material = new ShaderMaterial({
    vertexShader: 'void main() { gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 1.0, 1.0); }',
    fragmentShader: 'void main() { gl_FragColor = vec4(1.0); }',
    depthFunc: GreaterDepth, depthWrite: false, blending: CustomBlending,
    blendSrc: ZeroFactor, blendDst: OneFactor, blendSrcAlpha: OneFactor, blendDstAlpha: ZeroFactor,
  });
  return drawn(screen(), material, COVERED);
}
