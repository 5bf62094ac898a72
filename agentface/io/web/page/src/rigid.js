// Movements of what is one piece: a quaternion x y z w, then metres. Matrices are by columns, as WebGL takes them.

/** The rotation of a movement as nine numbers by rows. */
export function rotationOf(moved) {
  const length = Math.hypot(moved[0], moved[1], moved[2], moved[3]) || 1;
  const [x, y, z, w] = [moved[0] / length, moved[1] / length, moved[2] / length, moved[3] / length];
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w),
    2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
    2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y),
  ];
}

/** Sixteen numbers of a movement, its rotation times `scale`. */
export function matrixOf(moved, scale = 1) {
  const r = rotationOf(moved);
  return [
    scale * r[0], scale * r[3], scale * r[6], 0,
    scale * r[1], scale * r[4], scale * r[7], 0,
    scale * r[2], scale * r[5], scale * r[8], 0,
    moved[4], moved[5], moved[6], 1,
  ];
}

/** The product of two matrices. */
export function product(a, b) {
  const out = new Array(16).fill(0);
  for (let column = 0; column < 4; column++) {
    for (let row = 0; row < 4; row++) {
      for (let k = 0; k < 4; k++) out[4 * column + row] += a[4 * k + row] * b[4 * column + k];
    }
  }
  return out;
}

/** Sixteen numbers: what moves shoulders in a `breath` of 0 to 1; `filled` has three rows, what a whole one adds. */
export function breathing(filled, breath) {
  const at = (row, column) => (row === column ? 1 : 0) + (row < 3 ? breath * filled[4 * row + column] : 0);
  return Array.from({ length: 16 }, (_, i) => at(i % 4, i >> 2));
}

/** The frame of a face at rest. */
export function frameAtRest({ basis, atlas }) {
  return {
    skin: new Float64Array(basis.skin.scales.length),
    tongue: new Float64Array(basis.tongue.scales.length),
    eyes: [0, 0, 0, 1, 0, 0, 0, 1],
    pupils: [1, 1],
    eye_thrust: [0, 0],
    jaw: [0, 0, 0, 1, 0, 0, 0],
    head: [0, 0, 0, 1, 0, 0, 0],
    breath: 0,
    wrinkle_levels: new Float64Array(atlas.patches.length),
  };
}
