"""The limits of travel and squash, single precision; the numpy twin is :mod:`agentface.deform.muscles.limits`."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Floats
from agentface.deform.muscles import squash_compiled as squash
from agentface.deform.muscles.limits import LimitTables
from agentface.deform.simd_rows import dot, put_row, row_at
from agentface.kernel import kernel

_ONE = np.float32(1.0)


@kernel(error_model="numpy")
def apply(tables: LimitTables, points: Floats) -> None:
    """Bound the squash and the travel of ``points (P, 3)`` m in place; points within the bounds stay as they are."""
    squash.apply(tables.squash, points)
    rest, limits = tables.rest, tables.limit
    knee, above = np.float32(tables.knee), np.float32(1.0 - tables.knee)
    for point in range(rest.shape[0]):
        home = row_at(rest, 3 * point)
        way = row_at(points, 3 * point) - home
        square = dot(way, way)
        inside = knee * limits[point]
        if square > inside * inside:
            far = np.float32(math.sqrt(square))
            limit = limits[point]
            s = (far / limit - knee) / above
            scale = limit * (knee + above * s / (_ONE + s)) / far
            put_row(points, 3 * point, home + way * scale)
