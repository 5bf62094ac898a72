// Wrinkles finer than the mesh: agentface/view/skin/wrinkle_atlas.py, by its patches.

const EVEN = 128;

/** `texels`, the bytes of the atlas at the levels given last; `risen`: whether any wrinkle has. */
export class WrinkleAtlas {
  constructor({ side, grain, patches }) {
    this.side = side;
    this.grain = grain;
    this.patches = patches;
    this.levels = new Float64Array(patches.length);
    this.heights = new Float32Array(side * side);
    this.texels = new Uint8Array(4 * side * side).fill(EVEN);
    for (let i = 0; i < side * side; i++) this.texels[4 * i + 3] += grain[i];
    this.risen = false;
  }

  /** Combine the trains at `levels` 0..1; whether the texels are other ones than before. */
  update(levels) {
    if (levels.every((level, train) => level === this.levels[train])) return false;
    this.patches.forEach((patch, train) => { if (this.levels[train] > 0) this.smooth(patch); });
    this.patches.forEach((patch, train) => { if (levels[train] > 0) this.raise(patch, levels[train]); });
    this.levels.set(levels);
    this.risen = levels.some((level) => level > 0);
    return true;
  }

  smooth({ row, column, heights }) {
    const [high, wide] = heights.shape, { side, texels, grain } = this;
    for (let y = row; y < row + high; y++) {
      const first = y * side + column;
      this.heights.fill(0, first, first + wide);
      texels.fill(EVEN, 4 * first, 4 * (first + wide));
      for (let texel = first; texel < first + wide; texel++) texels[4 * texel + 3] = EVEN + grain[texel];
    }
  }

  /** Let the higher of two trains stand. */
  raise({ row, column, heights, relief }, level) {
    const [high, wide] = heights.shape, { side, texels, grain } = this, here = this.heights;
    const root = Math.trunc(256 * Math.sqrt(level)), whole = Math.trunc(256 * level);
    for (let y = 0, own = 0; y < high; y++) {
      for (let x = 0, texel = (row + y) * side + column; x < wide; x++, own++, texel++) {
        const height = level * heights[own];
        if (!(height > here[texel])) continue;
        here[texel] = height;
        const from = 4 * own, to = 4 * texel;
        texels[to] = EVEN + ((relief[from] * root) >> 8);
        texels[to + 1] = EVEN + ((relief[from + 1] * root) >> 8);
        texels[to + 2] = EVEN + ((relief[from + 2] * whole) >> 8);
        texels[to + 3] = EVEN + grain[texel] + ((relief[from + 3] * whole) >> 8);
      }
    }
  }
}
