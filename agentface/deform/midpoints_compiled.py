"""Vertices between those of rings, single precision; the numpy twin is :mod:`agentface.deform.midpoints`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.midpoints import MidpointTables
from agentface.kernel import kernel

_HALF = np.float32(0.5)


@kernel(error_model="numpy")
def apply(tables: MidpointTables, points: Floats) -> None:
    """Put each vertex of ``points (P, 3)`` m in the middle of its two."""
    for row in range(tables.rows.shape[0]):
        vertex, one, other = tables.rows[row, 0], tables.rows[row, 1], tables.rows[row, 2]
        for axis in range(3):
            points[vertex, axis] = _HALF * (points[one, axis] + points[other, axis])
