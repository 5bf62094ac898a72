// What the openings of the skin are like in a frame: mouth (agentface/view/parts/mouth.py) and eyes (rigid.py).

/** The uniforms of shaders/mouth.glsl. */
export function mouthUniforms({ corners, upper, lower, bow, gap_at_rest, half_at_rest, opened, pursed }, vertices) {
  const [rings, columns] = upper.shape, middle = Math.floor(columns / 2);
  const y = (vertex) => vertices[3 * vertex + 1], z = (vertex) => vertices[3 * vertex + 2];
  let gap = 0, weight = 0, high = 0, low = 0, front = 0;
  for (let column = 0; column < columns; column++) {
    let top = Infinity, bottom = -Infinity;
    for (let ring = 0; ring < rings; ring++) {
      top = Math.min(top, y(upper[ring * columns + column]));
      bottom = Math.max(bottom, y(lower[ring * columns + column]));
    }
    if (column === middle) [high, low] = [top, bottom];
    gap += Math.max(top - bottom, 0) * bow[column];
    weight += bow[column] * bow[column];
    front += 0.5 * (z(upper[column]) + z(lower[column])) / columns;
  }
  gap /= weight;
  const half = 0.5 * (vertices[3 * corners[0]] - vertices[3 * corners[1]]), centre = 0.5 * (high + low);
  const cornerY = 0.5 * (y(corners[0]) + y(corners[1])), cornerZ = 0.5 * (z(corners[0]) + z(corners[1]));
  return {
    mouth_light: Math.min(1, 0.03 + 0.97 * Math.max(0, (gap - gap_at_rest) / opened)),
    mouth_opening: [centre + 0.5 * gap, centre - 0.5 * gap, Math.abs(half), front],
    mouth_pursed: Math.min(Math.max((1 - half / half_at_rest) / pursed, 0), 1),
    mouth_bow: [front - cornerZ, cornerY - centre],
  };
}

/** The uniforms of shaders/eye.frag.glsl that follow the lids of an eye at `centre`. */
export function lidUniforms({ upper, lower, radius }, centre, vertices) {
  let least = Infinity, most = -Infinity;
  const lids = [upper, lower].map((lid) => {
    const rows = Array.from(lid, (vertex) => [0, 1].map((axis) => (vertices[3 * vertex + axis] - centre[axis]) / radius));
    for (const [x] of rows) [least, most] = [Math.min(least, x), Math.max(most, x)];
    return parabola(rows);
  });
  return { upper_lid: lids[0], lower_lid: lids[1], corners: [least, most] };
}

/** a, b, c of y = a + b x + c x^2, by least squares. */
function parabola(rows) {
  const m = [[1e-6, 0, 0, 0], [0, 1e-6, 0, 0], [0, 0, 1e-6, 0]];
  for (const [x, y] of rows) {
    const powers = [1, x, x * x];
    for (let i = 0; i < 3; i++) {
      for (let j = 0; j < 3; j++) m[i][j] += powers[i] * powers[j];
      m[i][3] += powers[i] * y;
    }
  }
  for (let i = 0; i < 3; i++) {
    const pivot = m.slice(i).reduce((best, row) => (Math.abs(row[i]) > Math.abs(best[i]) ? row : best));
    const k = m.indexOf(pivot);
    [m[i], m[k]] = [m[k], m[i]];
    for (let row = 0; row < 3; row++) {
      if (row === i) continue;
      const share = m[row][i] / m[i][i];
      for (let column = i; column < 4; column++) m[row][column] -= share * m[i][column];
    }
  }
  return [m[0][3] / m[0][0], m[1][3] / m[1][1], m[2][3] / m[2][2]];
}
