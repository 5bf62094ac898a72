"""The tiling volume of noise that the shaders draw their irregularities from."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Bytes, Doubles

SIDE = 32


def noise_volume(rng: np.random.Generator) -> Bytes:
    """``(32, 32, 32, 4)`` bytes that tile: two fractals, then two single octaves; means near 127."""
    channels = [
        _fractal(rng, (4, 8, 16, 32)),
        _fractal(rng, (4, 8, 16, 32)),
        _fractal(rng, (16,)),
        _fractal(rng, (16,)),
    ]
    return np.stack([np.clip(127.5 + 127.5 * channel, 0, 255).astype(np.uint8) for channel in channels], axis=-1)


def _fractal(rng: np.random.Generator, cells: tuple[int, ...]) -> Doubles:
    total = np.zeros((SIDE,) * 3)
    for i, count in enumerate(cells):
        total += 0.5**i * _smooth(rng.uniform(-1.0, 1.0, (count,) * 3))
    return np.asarray(total / np.abs(total).max())


def _smooth(grid: Doubles) -> Doubles:
    """A periodic grid interpolated to the volume's size by trigonometric polynomials."""
    for axis in range(3):
        count = grid.shape[axis]
        if count < SIDE:
            spectrum = np.fft.rfft(grid, axis=axis)
            grid = np.fft.irfft(spectrum, SIDE, axis=axis) * (SIDE / count)
    return grid
