"""Squashed heights raised, single precision; the numpy twin is :mod:`agentface.deform.muscles.squash`."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats
from agentface.deform.muscles.squash import SquashTables
from agentface.deform.simd_rows import dot, put_row, row_at
from agentface.kernel import kernel

_ONE = np.float32(1.0)


@kernel(error_model="numpy")
def apply(tables: SquashTables, points: Floats) -> None:
    """Raise the squashed heights of ``points (P, 3)`` m in place; points without any stay as they are."""
    for _ in range(tables.passes):
        if not _pass_over(tables, points):
            break


@kernel(error_model="numpy")
def _pass_over(tables: SquashTables, points: Floats) -> bool:
    """One pass over the heights, pair by pair; whether it raised any: where not, the next would raise none."""
    raised = False
    least, reach = np.float32(tables.least), np.float32(tables.least - tables.flat)
    for pair in range(tables.vertices.shape[0]):
        one, other = _left(tables, pair, 0, points), _left(tables, pair, 1, points)
        raised |= one < least or other < least
        if one < least:
            _raise(tables, pair, 0, (least - one) / reach, reach, points)
        if other < least:
            _raise(tables, pair, 1, (least - other) / reach, reach, points)
    return raised


@kernel(error_model="numpy", inline="always")
def _left(tables: SquashTables, pair: int, side: int, points: Floats) -> Any:
    height = 2 * pair + side
    a = row_at(points, 3 * tables.vertices[pair, side, 1])
    along = (row_at(points, 3 * tables.vertices[pair, side, 2]) - a) * tables.foot[pair, side]
    return dot(row_at(points, 3 * tables.vertices[pair, side, 0]) - a - along, row_at(tables.measure, 3 * height))


@kernel(error_model="numpy", inline="always")
def _raise(tables: SquashTables, pair: int, side: int, s: Any, reach: Any, points: Floats) -> None:
    push = row_at(tables.height, 3 * (2 * pair + side)) * (reach * s * s / (_ONE + s))
    for i in range(3):
        at = 3 * tables.vertices[pair, side, i]
        put_row(points, at, row_at(points, at) + push * tables.gives[pair, side, i])
