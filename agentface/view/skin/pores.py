"""The tiling volume of the skin's microrelief: a net of fine furrows with pits where pores and hairs are."""

from __future__ import annotations

from itertools import product

import numpy as np

from agentface.conventions import Bytes, Doubles

SIDE = 32
_CELLS = 8  # plates of skin along each side
_PIT, _PIT_DEPTH = 0.28, (0.2, 1.0)  # of a plate's width; parts of the deepest
_FURROW, _FURROW_DEPTH = 0.30, (0.25, 0.75)  # of a plate's width; parts of the deepest pit


def pore_volume(rng: np.random.Generator) -> Bytes:
    """``(32, 32, 32, 4)`` bytes that tile: the slopes of the relief along x, y, z (even at 128), then its height.

    Plates are the cells of scattered points (Worley 1996, "A cellular texture basis function"): furrows where two of
    them are equally near, a pit at each point.
    """
    corners = np.stack(np.meshgrid(*[np.arange(_CELLS)] * 3, indexing="ij"), axis=-1)
    points = corners + rng.random(corners.shape)
    depth = rng.uniform(*_PIT_DEPTH, corners.shape[:3]) ** 2
    at = np.stack(np.meshgrid(*[(np.arange(SIDE) + 0.5) * _CELLS / SIDE] * 3, indexing="ij"), axis=-1)
    nearest, second, pit = (np.full(at.shape[:3], value) for value in (np.inf, np.inf, 0.0))
    for beside in product((-1, 0, 1), repeat=3):
        away = np.abs(at - _by_texel(np.roll(points, beside, (0, 1, 2))))
        distance = np.sqrt((np.minimum(away, _CELLS - away) ** 2).sum(axis=-1))
        closer = distance < nearest
        second = np.where(closer, nearest, np.minimum(second, distance))
        pit = np.where(closer, _by_texel(np.roll(depth, beside, (0, 1, 2))), pit)
        nearest = np.where(closer, distance, nearest)
    furrow = _FURROW_DEPTH[0] + (_FURROW_DEPTH[1] - _FURROW_DEPTH[0]) * pit  # where pores are wide, skin is coarse
    height = 1.0 - furrow * np.exp(-(((second - nearest) / _FURROW) ** 2)) - pit * np.exp(-((nearest / _PIT) ** 2))
    height = _softened(height)
    slopes = np.stack([np.roll(height, -1, axis) - np.roll(height, 1, axis) for axis in range(3)], axis=-1)
    slopes /= np.abs(slopes).max()
    height = (height - height.min()) / np.ptp(height)
    rows = np.concatenate([128.0 + 127.0 * slopes, 255.0 * height[..., None]], axis=-1)
    return np.round(rows).astype(np.uint8).transpose(2, 1, 0, 3)


def _by_texel(cells: Doubles) -> Doubles:
    """What the plates have, for each texel in them."""
    for axis in range(3):
        cells = np.repeat(cells, SIDE // _CELLS, axis)
    return cells


def _softened(height: Doubles) -> Doubles:
    """No step between texels that a look between them would show."""
    for axis in range(3):
        height = 0.5 * height + 0.25 * (np.roll(height, 1, axis) + np.roll(height, -1, axis))
    return height
