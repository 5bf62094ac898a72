// The skin of a frame: the basis' modes, then the last stages of every deformer's skin (agentface/deform/finish).

import { rotationOf } from './rigid.js';

/** `vertices` and unit `normals` before wrinkles rise, `(V, 3)` each in one row. */
export class Skin {
  constructor(head) {
    this.rest = head.rest.vertices;
    this.triangles = head.rest.triangles;
    this.count = this.rest.length / 3;
    this.basis = head.basis.skin;
    this.tables = head.finish;
    this.vertices = Float32Array.from(this.rest);
    this.normals = new Float32Array(this.rest.length);
    this.heights = new Float32Array(this.count);
    this.sums = new Float64Array(this.rest.length);
    writeNormals(this.vertices, this.triangles, this.sums, this.normals);
  }

  /** Take `frame`: weights `skin` or the places `vertices`, `wrinkle_levels`, `head`. */
  update(frame) {
    if (frame.vertices) addTo(this.vertices, this.rest, frame.vertices);
    else moveBy(this.vertices, this.rest, this.basis, frame.skin);
    writeNormals(this.vertices, this.triangles, this.sums, this.normals);
    this.raise(frame.wrinkle_levels ?? []);
    this.holdNeck(frame.head);
  }

  /** At each vertex the highest of the trains (Bui et al., section 4), along the normal before. */
  raise(levels) {
    const { first, vertices, heights } = this.tables.wrinkles;
    this.heights.fill(0);
    for (let train = 0; train + 1 < first.length; train++) {
      if (!(levels[train] > 0)) continue;
      for (let entry = first[train]; entry < first[train + 1]; entry++) {
        const height = levels[train] * heights[entry];
        if (height > this.heights[vertices[entry]]) this.heights[vertices[entry]] = height;
      }
    }
    for (let vertex = 0; vertex < this.count; vertex++) {
      const height = this.heights[vertex];
      if (height > 0) for (let i = 3 * vertex; i < 3 * vertex + 3; i++) this.vertices[i] += height * this.normals[i];
    }
  }

  /** The neck turns less and less down to the collar: a part of the head's turn is taken back. */
  holdNeck(head) {
    const turn = rotationOf(head);
    if (turn[0] === 1 && turn[4] === 1 && turn[8] === 1) return;
    const { where, stays } = this.tables.neck;
    for (let entry = 0; entry < where.length; entry++) {
      const at = 3 * where[entry], share = stays[entry];
      turnBack(this.vertices, at, share, turn, head[4], head[5], head[6]);
      turnBack(this.normals, at, share, turn, 0, 0, 0);
      const length = Math.hypot(this.normals[at], this.normals[at + 1], this.normals[at + 2]) || 1;
      for (let i = at; i < at + 3; i++) this.normals[i] /= length;
    }
  }
}

function turnBack(rows, at, share, turn, ox, oy, oz) {
  const x = rows[at] - ox, y = rows[at + 1] - oy, z = rows[at + 2] - oz;
  for (let axis = 0; axis < 3; axis++) {
    const home = x * turn[axis] + y * turn[3 + axis] + z * turn[6 + axis];
    rows[at + axis] += share * (home - rows[at + axis]);
  }
}

function addTo(out, rest, moved) {
  for (let i = 0; i < out.length; i++) out[i] = rest[i] + moved[i];
}

/** `out` = rest + the sum of `weights` times the modes of `basis`. */
export function moveBy(out, rest, { shapes, scales }, weights) {
  out.set(rest);
  const one = typeof weights === 'number' ? [weights] : weights, size = out.length;
  const moving = [];
  for (let mode = 0; mode < scales.length; mode++) if (one[mode] !== 0) moving.push(mode);
  // four at once: what is moved is read and written a quarter as often
  for (let first = 0; first < moving.length; first += 4) {
    const [a, b = a, c = a, d = a] = moving.slice(first, first + 4);
    const left = moving.length - first;
    const wa = one[a] * scales[a], wb = left > 1 ? one[b] * scales[b] : 0, wc = left > 2 ? one[c] * scales[c] : 0, wd = left > 3 ? one[d] * scales[d] : 0;
    const sa = shapes.subarray(a * size, (a + 1) * size), sb = shapes.subarray(b * size, (b + 1) * size);
    const sc = shapes.subarray(c * size, (c + 1) * size), sd = shapes.subarray(d * size, (d + 1) * size);
    for (let i = 0; i < size; i++) out[i] += wa * sa[i] + wb * sb[i] + wc * sc[i] + wd * sd[i];
  }
}

/** Unit normals of a mesh: the means of its triangles', by their areas. */
export function writeNormals(vertices, triangles, sums, normals) {
  sums.fill(0);
  for (let corner = 0; corner < triangles.length; corner += 3) {
    const a = 3 * triangles[corner], b = 3 * triangles[corner + 1], c = 3 * triangles[corner + 2];
    const ux = vertices[b] - vertices[a], uy = vertices[b + 1] - vertices[a + 1], uz = vertices[b + 2] - vertices[a + 2];
    const vx = vertices[c] - vertices[a], vy = vertices[c + 1] - vertices[a + 1], vz = vertices[c + 2] - vertices[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx;
    sums[a] += x; sums[a + 1] += y; sums[a + 2] += z;
    sums[b] += x; sums[b + 1] += y; sums[b + 2] += z;
    sums[c] += x; sums[c + 1] += y; sums[c + 2] += z;
  }
  for (let i = 0; i < sums.length; i += 3) {
    const length = Math.hypot(sums[i], sums[i + 1], sums[i + 2]) || 1;
    normals[i] = sums[i] / length;
    normals[i + 1] = sums[i + 1] / length;
    normals[i + 2] = sums[i + 2] / length;
  }
}
