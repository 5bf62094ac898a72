// The lips cut finely, on their B-spline surface: agentface/view/skin/fine_lips.py, by its tables.

/** `places` and unit `normals` of the fine vertices, `(F, 3)` each in one row. */
export class FineLips {
  constructor(tables, rest) {
    this.tables = tables;
    this.count = tables.own.length;
    this.places = new Float32Array(3 * this.count);
    this.normals = new Float32Array(3 * this.count);
    const size = tables.patch.length, controls = tables.fit.shape[0];
    this.rest = gathered(rest, tables.patch, new Float64Array(3 * size));
    this.moved = new Float64Array(3 * size);
    this.facing = new Float64Array(3 * size);
    this.there = new Float64Array(3 * size);
    this.control = new Float64Array(3 * controls);
    this.sums = [0, 1, 2, 3].map(() => new Float64Array(3 * this.count));
  }

  /** Take the skin's `vertices` and `normals`. */
  update(vertices, normals) {
    const { patch, fit, patch_controls, patch_weight, share_of, share, controls, weight, rest, own } = this.tables;
    gathered(vertices, patch, this.moved);
    for (let i = 0; i < this.moved.length; i++) this.moved[i] -= this.rest[i];
    gathered(normals, patch, this.facing);
    multiplied(fit, this.moved, this.control);
    mixed(this.control, patch_controls, patch_weight, this.there);
    const [still, there, smooth, surface] = this.sums;
    mixed(this.moved, share_of, share, still);
    mixed(this.there, share_of, share, there);
    mixed(this.facing, share_of, share, smooth);
    mixed(this.control, controls, weight, surface);
    for (let i = 0; i < this.places.length; i++) {
      this.places[i] = rest[i] + still[i] + own[Math.floor(i / 3)] * (surface[i] - there[i]);
    }
    this.turn(smooth);
  }

  /** Normals of the grid itself, which go over into those of the skin beyond at its edge. */
  turn(smooth) {
    const { rings, columns, own } = this.tables, { places, normals } = this;
    const at = (ring, column) => 3 * (ring * columns + column);
    for (let ring = 0; ring < rings; ring++) {
      const before = Math.max(ring - 1, 0), behind = Math.min(ring + 1, rings - 1);
      for (let column = 0; column < columns; column++) {
        const up = at(behind, column), down = at(before, column), here = at(ring, column);
        const next = at(ring, (column + 1) % columns), last = at(ring, (column + columns - 1) % columns);
        const u = [0, 1, 2].map((axis) => places[up + axis] - places[down + axis]);
        const v = [0, 1, 2].map((axis) => places[next + axis] - places[last + axis]);
        const n = unit([u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]);
        const part = own[here / 3];
        const facing = unit([0, 1, 2].map((axis) => part * n[axis] + (1 - part) * smooth[here + axis]));
        normals.set(facing, here);
      }
    }
  }
}

function unit(v) {
  const length = Math.max(Math.hypot(v[0], v[1], v[2]), 1e-12);
  return [v[0] / length, v[1] / length, v[2] / length];
}

function gathered(rows, index, out) {
  for (let i = 0; i < index.length; i++) {
    for (let axis = 0; axis < 3; axis++) out[3 * i + axis] = rows[3 * index[i] + axis];
  }
  return out;
}

/** `matrix (M, N)` times `rows (N, 3)`. */
function multiplied(matrix, rows, out) {
  const [height, width] = matrix.shape;
  for (let row = 0; row < height; row++) {
    let x = 0, y = 0, z = 0;
    for (let i = 0, at = row * width; i < width; i++, at++) {
      x += matrix[at] * rows[3 * i];
      y += matrix[at] * rows[3 * i + 1];
      z += matrix[at] * rows[3 * i + 2];
    }
    out[3 * row] = x; out[3 * row + 1] = y; out[3 * row + 2] = z;
  }
}

/** Sums of sixteen rows each, by weight. */
function mixed(rows, index, weight, out) {
  for (let i = 0; 3 * i < out.length; i++) {
    let x = 0, y = 0, z = 0;
    for (let k = 16 * i; k < 16 * i + 16; k++) {
      const at = 3 * index[k];
      x += weight[k] * rows[at];
      y += weight[k] * rows[at + 1];
      z += weight[k] * rows[at + 2];
    }
    out[3 * i] = x; out[3 * i + 1] = y; out[3 * i + 2] = z;
  }
}
