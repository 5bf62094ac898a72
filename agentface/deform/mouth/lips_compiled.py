"""The lips' loops; their numpy twins are in :mod:`agentface.deform.mouth.lips`."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.mouth import lips
from agentface.deform.mouth.lip_surface import COLUMNS, ROWS
from agentface.deform.mouth.lips import RED, THINNED, LipTables
from agentface.deform.simd_rows import put_row, row_at, row_of, wide_row_at
from agentface.kernel import kernel

_CONTROLS = COLUMNS * ROWS
_ZERO, _HALF, _ONE = np.float32(0.0), np.float32(0.5), np.float32(1.0)
_THINNED = np.array(THINNED)
_thinning = kernel(error_model="numpy")(lips.thinning)
_rolled = kernel(error_model="numpy")(lips.rolled)


@kernel(error_model="numpy", inline="always")
def _mean(controls: Indices, weights: Floats, row: int, count: int, moved: Floats) -> Any:
    """The movements ``moved (C, 4)`` of a row of ``controls (N, K)``, by ``weights (N, K)``.

    ``count`` is K, which the compiler has to know to unroll the loop.
    """
    mean = row_of(_ZERO)
    for j in range(count):
        mean = mean + wide_row_at(moved, 4 * controls[row, j]) * weights[row, j]
    return mean


@kernel(error_model="numpy")
def slice_steps(tables: LipTables, values: Floats, step: float, shares: Floats) -> None:
    """Which part of each contraction acts in each step; as its twin."""
    pucker, press = values[tables.parameters[0]], values[tables.parameters[1]]
    roll = _rolled(press, tables.roll_from)
    shares[:] = _ZERO
    for index in range(shares.shape[0] - 1):
        start, end = np.float32(index * step), np.float32((index + 1) * step)
        shares[index, 0] = _part(min(start, pucker), min(end, pucker), pucker, index)
        shares[index, 1] = _part(min(start, press), min(end, press), press, index)
        before, after = _rolled(min(start, press), tables.roll_from), _rolled(min(end, press), tables.roll_from)
        shares[index, 2] = _part(before, after, roll, index)


@kernel(error_model="numpy")
def _part(before: Any, after: Any, whole: Any, index: int) -> Any:
    if whole == _ZERO:
        return _ONE if index == 0 else _ZERO
    return (after - before) / whole


@kernel(error_model="numpy")
def contract(tables: LipTables, values: Floats, found: Floats, points: Floats) -> None:
    """Orbicularis oris moves the control points and the skin at the patch's edge; as its twin."""
    pucker, press = values[tables.parameters[0]], values[tables.parameters[1]]
    start = tables.skin_count
    left, right = points[start + RED[0], 0], points[start + ROWS * (COLUMNS // 2) + RED[0], 0]
    thinner = _thinning(left - right, tables.width) * max(_ZERO, _ONE - pucker - press)
    if pucker == _ZERO and press == _ZERO and thinner == _ZERO:
        return
    roll = _rolled(press, tables.roll_from)
    moved = np.empty((_CONTROLS, 4), np.float32)
    for i in range(_CONTROLS):
        row = i % ROWS
        red, other, share = start + i - row + RED[0], start + i - row + RED[1], thinner * _THINNED[row]
        y, home = points[start + i, 1], tables.control_rest[i, 1]
        across = pucker * (tables.shift[0, i, 0] + tables.pull[0, i] * (tables.target[0, i, 0] - found[i, 0]))
        across += press * (tables.shift[1, i, 0] + tables.pull[1, i] * (tables.target[1, i, 0] - found[i, 1]))
        across += roll * (tables.shift[2, i, 0] + tables.pull[2, i] * (tables.target[2, i, 0] - found[i, 2]))
        up = pucker * (tables.shift[0, i, 1] + tables.pull[0, i] * (tables.target[0, i, 1] - home))
        up += press * (tables.shift[1, i, 1] + tables.pull[1, i] * (tables.target[1, i, 1] - home))
        up += roll * (tables.shift[2, i, 1] + tables.pull[2, i] * (tables.target[2, i, 1] - home))
        ahead = pucker * tables.shift[0, i, 2] + press * tables.shift[1, i, 2] + roll * tables.shift[2, i, 2]
        up -= share * (y - _HALF * (points[red, 1] + points[other, 1]))
        ahead -= share * (points[start + i, 2] - _HALF * (points[red, 2] + points[other, 2]))
        moved[i, 0], moved[i, 1], moved[i, 2], moved[i, 3] = across, up, ahead, _ZERO
    for k in range(tables.rim.shape[0]):
        row = tables.rim[k]
        at = 3 * tables.patch[row]
        put_row(points, at, row_at(points, at) + _mean(tables.controls, tables.weight, row, 16, moved))
    for k in range(tables.skirt.shape[0]):
        at = 3 * tables.skirt[k]
        put_row(points, at, row_at(points, at) + _mean(tables.skirt_index, tables.skirt_weight, k, 4, moved))
    for i in range(_CONTROLS):
        points[start + i, 0] += moved[i, 0]
        points[start + i, 1] += moved[i, 1]
        points[start + i, 2] += moved[i, 2]


@kernel(error_model="numpy")
def surface(tables: LipTables, points: Floats) -> None:
    """The vertices of the patch take the surface's movement; as its twin."""
    start = tables.skin_count
    moved = np.empty((_CONTROLS, 4), np.float32)
    for i in range(_CONTROLS):
        moved[i, 0] = points[start + i, 0] - tables.control_rest[i, 0]
        moved[i, 1] = points[start + i, 1] - tables.control_rest[i, 1]
        moved[i, 2] = points[start + i, 2] - tables.control_rest[i, 2]
        moved[i, 3] = _ZERO
    for row in range(tables.patch.shape[0]):
        at = 3 * tables.patch[row]
        there = row_at(tables.rest, 3 * row) + _mean(tables.controls, tables.weight, row, 16, moved)
        here = row_at(points, at)
        put_row(points, at, here + (there - here) * tables.blend[row])
