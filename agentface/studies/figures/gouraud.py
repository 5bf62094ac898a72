"""A mesh drawn in smooth shading: the light of each triangle's corners, interpolated, as the paper's OpenGL did."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Bytes, Doubles, Indices
from agentface.studies.figures.mesh_view import SKIN, MeshView

_LIGHT = np.array([-0.25, 0.85, 0.45]) / np.linalg.norm([-0.25, 0.85, 0.45])
_AMBIENT = 0.25
_EMPTY = 255
_AT_ONCE = 2**20
"""Pixels that are looked at together."""


def smooth_picture(view: MeshView, points: Doubles, triangles: Indices, normals: Doubles) -> Bytes:
    """``(S, S, 3)``: ``points (V, 3)`` m seen by ``view``, lit by the corners' ``normals (T, 3, 3)``."""
    pixels = view.pixels(points)
    light = _AMBIENT + (1.0 - _AMBIENT) * np.clip(view.turned(normals.reshape(-1, 3)) @ _LIGHT, 0.0, 1.0)
    bright = np.full((view.size, view.size, 1), np.nan)
    fill(bright, np.full((view.size, view.size), -np.inf), pixels[triangles], light.reshape(-1, 3, 1))
    shown = np.where(np.isnan(bright), _EMPTY, bright * SKIN)
    return np.round(np.clip(shown, 0, 255)).astype(np.uint8)


def fill(values: Doubles, near: Doubles, corners: Doubles, own: Doubles, cuts: int = 0) -> None:
    """Draw triangles into ``values (S, S, K)``, where they are nearer than ``near (S, S)``, and their depth into that.

    ``corners (T, 3, 3)`` are columns, rows and depth; ``own (T, 3, K)`` what the corners have of the values, which is
    interpolated between them. Where one of the last ``cuts`` values is negative, nothing is drawn.
    """
    low, high = np.floor(corners[..., :2].min(axis=1)), np.ceil(corners[..., :2].max(axis=1))
    low, high = (np.clip(end, 0, len(near)).astype(np.int64) for end in (low, high))
    wide = (high - low).max(axis=1)
    inside = (high > low).all(axis=1)
    side = 4
    while inside.any():
        chosen = np.flatnonzero(inside & (wide <= side))
        inside[chosen] = False
        for part in np.array_split(chosen, 1 + len(chosen) * side * side // _AT_ONCE):
            _fill(values, near, corners[part], own[part], low[part], side, cuts)
        side *= 2


def _fill(values: Doubles, near: Doubles, corners: Doubles, own: Doubles, low: Indices, side: int, cuts: int) -> None:
    """Draw triangles that lie within ``side`` pixels from their corner ``low``."""
    a, b, c = (corners[:, i, None, None, :2] for i in range(3))
    step = np.arange(side) + 0.5
    x = (low[:, 0, None] + step)[:, None] - a[..., 0]
    y = (low[:, 1, None] + step)[:, :, None] - a[..., 1]
    (bx, by), (cx, cy) = (np.moveaxis(other - a, -1, 0) for other in (b, c))
    area = bx * cy - cx * by
    with np.errstate(divide="ignore", invalid="ignore"):  # of a triangle seen from its edge: not drawn
        second, third = (x * cy - cx * y) / area, (bx * y - x * by) / area
        shares = np.stack([1.0 - second - third, second, third], axis=-1)
    which, row, column = np.nonzero((shares >= 0.0).all(axis=-1))
    shares = shares[which, row, column]
    row, column = row + low[which, 1], column + low[which, 0]
    depth = (shares * corners[which, :, 2]).sum(axis=1)
    on = (row < len(near)) & (column < len(near))
    if cuts:
        on &= ((shares[..., None] * own[which, :, -cuts:]).sum(axis=1) >= 0.0).all(axis=1)
    on[on] = depth[on] > near[row[on], column[on]]
    order = np.flatnonzero(on)[np.argsort(depth[on], kind="stable")]  # the nearest is written last
    place = row[order], column[order]
    near[place] = depth[order]
    values[place] = (shares[order][..., None] * own[which[order]]).sum(axis=1)
