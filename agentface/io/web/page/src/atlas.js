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

  smooth(patch) {
    this.each(patch, (_, texel) => {
      this.heights[texel] = 0;
      this.texels.fill(EVEN, 4 * texel, 4 * texel + 4);
      this.texels[4 * texel + 3] += this.grain[texel];
    });
  }

  /** Let the higher of two trains stand. */
  raise(patch, level) {
    const { heights, relief } = patch, root = Math.trunc(256 * Math.sqrt(level)), whole = Math.trunc(256 * level);
    this.each(patch, (own, texel) => {
      const height = level * heights[own];
      if (!(height > this.heights[texel])) return;
      this.heights[texel] = height;
      const from = 4 * own, to = 4 * texel;
      this.texels[to] = EVEN + ((relief[from] * root) >> 8);
      this.texels[to + 1] = EVEN + ((relief[from + 1] * root) >> 8);
      this.texels[to + 2] = EVEN + ((relief[from + 2] * whole) >> 8);
      this.texels[to + 3] = EVEN + this.grain[texel] + ((relief[from + 3] * whole) >> 8);
    });
  }

  each({ row, column, heights }, what) {
    const [high, wide] = heights.shape;
    for (let own = 0, y = row; y < row + high; y++) {
      for (let texel = y * this.side + column, end = texel + wide; texel < end; texel++, own++) what(own, texel);
    }
  }
}
