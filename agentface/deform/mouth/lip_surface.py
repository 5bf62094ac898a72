"""The lips' B-spline surface: 24 x 6 control points, closed round the mouth, fitted to the mesh at rest."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.deform.mouth.lip_grid import LipGrid, column_places
from agentface.mesh import bspline
from agentface.mesh.smoothstep import smoothstep

COLUMNS, ROWS = 24, 6
"""The control grid; control point ``column * ROWS + row``, column 0 at the left corner, 6 in the upper lip's middle,
row 0 inside the mouth, row 5 on the skin."""
_ROUND, _ROUND_ALONG = 1.5, (0.5, 0.85)
"""Columns from a corner of the mouth over which it opens round, and where along the surface that ends."""
_CORNER, _ROOT = 0.4, 0.65
"""Columns round a corner that move as the surface does; the exponent of the root."""
_STIFFNESS = 0.045  # how strongly the fit prefers an even control grid to the mesh's last tenth of a millimetre


def weights(across: Doubles, along: Doubles) -> tuple[Indices, Doubles]:
    """Control points and weights ``(..., 16)`` of the surface at ``across`` (0..24, closed) and ``along`` (0..1)."""
    column, of_column = bspline.closed(across, COLUMNS)
    row, of_row = bspline.clamped(along, ROWS)
    index = column[..., :, None] * ROWS + row[..., None, :]
    weight = of_column[..., :, None] * of_row[..., None, :]
    return index.reshape(*across.shape, 16).astype(np.int32), weight.reshape(*across.shape, 16)


def grid_places(grid: LipGrid, points: Doubles) -> tuple[Doubles, Doubles]:
    """Where the grid's columns ``(N,)`` and rings ``(R,)`` lie on the surface, 0..24 and 0..1.

    Rings are as far apart as the root of their mean distance in space: the red, where rings are dense, gets more
    of the six rows than its width would give it.
    """
    steps = np.sqrt(np.linalg.norm(np.diff(points[grid.vertices], axis=0), axis=2).mean(1))
    along = np.concatenate([[0.0], np.cumsum(steps)]) / steps.sum()
    along[-1] = 1.0
    return column_places(grid, points, COLUMNS), along


def moved_with(across: Doubles, along: Doubles) -> Doubles:
    """``(..., )`` 0..24: the place across the surface whose movement a point at ``across`` and ``along`` makes.

    A spline of 24 columns opens like a wedge. Near the corners of the mouth, and less beyond the border of the red, a
    point moves like one that is further from the corner, by the root of its own distance: the mouth opens round.
    """
    half = COLUMNS / 2
    off = (across + 0.5 * half) % half - 0.5 * half  # from the nearer corner
    far = np.maximum(np.abs(off) - _CORNER, 0.0)
    root = _ROUND * (far / _ROUND) ** _ROOT
    near = 1.0 - smoothstep(0.0, 1.6 * _ROUND, far)
    share = 1.0 - smoothstep(*_ROUND_ALONG, along)
    return np.asarray((across + np.sign(off) * near * share * (root - far)) % COLUMNS)


def fit(index: Indices, weight: Doubles, places: Doubles) -> Doubles:
    """The control points ``(144, 3)`` whose surface passes nearest to ``places (P, 3)``, made symmetric."""
    count = COLUMNS * ROWS
    rows = np.zeros((len(places), count))
    np.put_along_axis(rows, index.astype(np.int64), weight, axis=1)
    number = np.arange(count).reshape(COLUMNS, ROWS)
    bends = [(np.roll(number, 1, 0), number, np.roll(number, -1, 0)), (number[:, :-2], number[:, 1:-1], number[:, 2:])]
    stiff = []
    for before, at, after in bends:
        bend = np.zeros((at.size, count))
        for where, value in ((before, 1.0), (at, -2.0), (after, 1.0)):
            bend[np.arange(at.size), where.ravel()] = _STIFFNESS * value
        stiff.append(bend)
    system = np.concatenate([rows, *stiff])
    right = np.concatenate([places, np.zeros((len(system) - len(places), 3))])
    control = np.linalg.solve(system.T @ system, system.T @ right)
    return np.asarray(0.5 * (control + control[mirrored_controls()] * [-1.0, 1.0, 1.0]))


def mirrored_controls() -> Indices:
    """``(144,)``: the control point that is each one's image in the median plane."""
    number = np.arange(COLUMNS * ROWS, dtype=np.int32).reshape(COLUMNS, ROWS)
    return number[(COLUMNS // 2 - np.arange(COLUMNS)) % COLUMNS].ravel()


def control_places(grid: LipGrid, across: Doubles, along: Doubles) -> tuple[Indices, Doubles]:
    """The four vertices of the grid round the place where each control point acts most, and their weights."""
    order = np.argsort(across)
    column = np.searchsorted(across[order], np.arange(COLUMNS), side="right")
    ends = order[np.stack([column - 1, column % len(order)])]
    gap = (across[ends[1]] - across[ends[0]]) % COLUMNS
    part = ((np.arange(COLUMNS) - across[ends[0]]) % COLUMNS) / gap
    of_column = np.stack([1 - part, part])
    place = bspline.greville(ROWS)
    ring = np.clip(np.searchsorted(along, place, side="right") - 1, 0, len(along) - 2)
    step = (place - along[ring]) / (along[ring + 1] - along[ring])
    rings, of_ring = np.stack([ring, ring + 1]), np.stack([1 - step, step])
    vertex = grid.vertices[rings[:, None, None, :], ends[None, :, :, None]]
    share = of_ring[:, None, None, :] * of_column[None, :, :, None]
    skin = vertex.reshape(4, -1).T
    return np.ascontiguousarray(skin, np.int32), np.ascontiguousarray(share.reshape(4, -1).T)
