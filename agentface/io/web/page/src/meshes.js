// Meshes for three.js from the head's record, in the order in which a portrait is drawn (agentface/view/renderer.py).

import {
  AddEquation, BackSide, BufferAttribute, BufferGeometry, CustomBlending, DoubleSide, FrontSide, GLSL3, IntType, LessDepth, Mesh,
  OneFactor, OneMinusSrcAlphaFactor, RawShaderMaterial, SrcAlphaFactor, ZeroFactor,
} from 'three';

const SIDES = { outer: FrontSide, inner: BackSide, both: DoubleSide };
const SOLID = {};
const HAIRY = {
  // the colour of what is covered, its opacity as it was: the samples that hair covers are chosen by coverage
  alphaToCoverage: true, blending: CustomBlending, blendEquation: AddEquation,
  blendSrc: OneFactor, blendDst: ZeroFactor, blendSrcAlpha: ZeroFactor, blendDstAlpha: OneFactor,
};
const SOFT = {
  transparent: true, forceSinglePass: true, blending: CustomBlending, blendEquation: AddEquation,
  blendSrc: SrcAlphaFactor, blendDst: OneMinusSrcAlphaFactor, blendSrcAlpha: OneFactor, blendDstAlpha: OneMinusSrcAlphaFactor,
};

/** Makes materials of one head: `programs` by name, the uniforms `common` to all, the uniform block `frame`. */
export class Materials {
  constructor(programs, common, frame) {
    this.programs = programs;
    this.common = common;
    this.frame = frame;
    this.made = [];
  }

  material(program, own = {}, state = {}) {
    const { vertex, fragment } = this.programs[program];
    const uniforms = { ...this.common };
    for (const [name, value] of Object.entries(own)) uniforms[name] = { value };
    const material = new RawShaderMaterial({
      name: program, glslVersion: GLSL3, vertexShader: bare(vertex), fragmentShader: bare(fragment), uniforms,
      depthFunc: LessDepth, toneMapped: false, ...state,
    });
    if (vertex.includes('uniform Frame')) material.uniformsGroups = [this.frame];
    this.made.push(material);
    return material;
  }

  solid(program, own, side = 'outer') {
    return this.material(program, own, { side: SIDES[side], ...SOLID });
  }

  hairy(program, own, side) {
    return this.material(program, own, { side: SIDES[side], ...HAIRY });
  }

  soft(program, own, side = 'both', state = {}) {
    return this.material(program, own, { side: SIDES[side], ...SOFT, ...state });
  }

  dispose() {
    for (const material of this.made) material.dispose();
  }
}

// three.js writes the version itself
function bare(shader) {
  return shader.replace(/^#version 300 es\n/, '');
}

/** The geometry of a record with `fields` and `triangles`. */
export function geometryOf({ fields, triangles }) {
  const geometry = new BufferGeometry();
  for (const [name, field] of Object.entries(fields)) geometry.setAttribute(name, attributeOf(field));
  geometry.setIndex(new BufferAttribute(triangles, 1));
  return geometry;
}

/** Rows of numbers for a shader: floats, or whole ones. */
export function attributeOf(field) {
  const width = field.shape?.[1] ?? 1;
  if (field instanceof Float32Array) return new BufferAttribute(field, width);
  const attribute = new BufferAttribute(Int32Array.from(field), width);
  attribute.gpuType = IntType;
  return attribute;
}

/** The skin's geometry: its fields, each the mean of what the two `ends` of a vertex have. */
export function skinGeometry({ fields, ends, triangles }) {
  const count = ends.length / 2;
  const means = { ends: Object.assign(ends, { shape: [count, 2] }) };
  for (const [name, field] of Object.entries(fields)) {
    const width = field.shape[1], mean = new Float32Array(count * width);
    for (let i = 0; i < count; i++) {
      const a = width * ends[2 * i], b = width * ends[2 * i + 1];
      for (let k = 0; k < width; k++) mean[width * i + k] = 0.5 * (field[a + k] + field[b + k]);
    }
    means[name] = Object.assign(mean, { shape: [count, width] });
  }
  return geometryOf({ fields: means, triangles });
}

/** A part of a geometry: the triangles from `first` on, `count` of them or all. */
export function partOf(geometry, first, count = Infinity) {
  const part = new BufferGeometry();
  for (const [name, attribute] of Object.entries(geometry.attributes)) part.setAttribute(name, attribute);
  part.setIndex(geometry.index);
  part.setDrawRange(3 * first, Math.min(3 * count, geometry.index.count - 3 * first));
  return part;
}

/** A mesh that is drawn always, as the `order`-th. */
export function drawn(geometry, material, order) {
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  mesh.matrixAutoUpdate = false;
  mesh.renderOrder = order;
  return mesh;
}
