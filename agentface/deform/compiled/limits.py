"""The limits of travel and squash, single precision; the numpy twins are in ``agentface.deform``'s modules."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

from agentface.conventions import Floats
from agentface.deform.limits import LimitTables
from agentface.deform.squash import SquashTables

_ZERO, _ONE = np.float32(0.0), np.float32(1.0)


@njit(cache=True, nogil=True, error_model="numpy")
def apply(tables: LimitTables, points: Floats) -> None:
    """Bound the squash and the travel of ``points (P, 3)`` m in place; points within the bounds stay as they are."""
    for _ in range(tables.squash.passes):
        unsquash(tables.squash, points)
    rest, limits = tables.rest, tables.limit
    knee, above = np.float32(tables.knee), np.float32(1.0 - tables.knee)
    for point in range(rest.shape[0]):
        x = points[point, 0] - rest[point, 0]
        y = points[point, 1] - rest[point, 1]
        z = points[point, 2] - rest[point, 2]
        square = x * x + y * y + z * z
        inside = knee * limits[point]
        if square > inside * inside:
            far = np.float32(math.sqrt(square))
            limit = limits[point]
            s = (far / limit - knee) / above
            scale = limit * (knee + above * s / (_ONE + s)) / far
            points[point, 0] = rest[point, 0] + scale * x
            points[point, 1] = rest[point, 1] + scale * y
            points[point, 2] = rest[point, 2] + scale * z


@njit(cache=True, nogil=True, error_model="numpy")
def unsquash(tables: SquashTables, points: Floats) -> None:
    """One pass over the heights, pair by pair."""
    least, reach = np.float32(tables.least), np.float32(tables.least - tables.flat)
    for pair in range(tables.vertices.shape[0]):
        one, other = _left(tables, pair, 0, points), _left(tables, pair, 1, points)
        if one < least:
            _raise(tables, pair, 0, (least - one) / reach, reach, points)
        if other < least:
            _raise(tables, pair, 1, (least - other) / reach, reach, points)


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _left(tables: SquashTables, pair: int, side: int, points: Floats) -> Any:
    p, a, b = tables.vertices[pair, side, 0], tables.vertices[pair, side, 1], tables.vertices[pair, side, 2]
    foot, left = tables.foot[pair, side], _ZERO
    for axis in range(3):
        height = points[p, axis] - points[a, axis] - foot * (points[b, axis] - points[a, axis])
        left += height * tables.measure[pair, side, axis]
    return left


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _raise(tables: SquashTables, pair: int, side: int, s: Any, reach: Any, points: Floats) -> None:
    push = reach * s * s / (_ONE + s)
    for i in range(3):
        point, part = tables.vertices[pair, side, i], tables.gives[pair, side, i]
        for axis in range(3):
            points[point, axis] += part * (push * tables.height[pair, side, axis])
