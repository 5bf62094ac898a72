"""The head's turn, compiled; the numpy twin is :mod:`agentface.deform.finish.head_turn`."""

from __future__ import annotations

import math

from agentface.conventions import Floats
from agentface.deform.finish.head_turn import HeadTurnTables
from agentface.kernel import kernel


@kernel(error_model="numpy")
def apply(tables: HeadTurnTables, values: Floats, transform: Floats) -> None:
    """Write the turn of the head about the neck into ``transform (4, 4)``."""
    yaw, pitch, roll = float(values[tables.yaw]), float(values[tables.pitch]), float(values[tables.roll])
    cy, sy, cp, sp, cr, sr = (
        math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch), math.cos(roll), math.sin(roll),
    )  # fmt: skip
    rows = (
        (cy * cr + sy * sp * sr, cy * sr - sy * sp * cr, sy * cp),
        (-cp * sr, cp * cr, sp),
        (cy * sp * sr - sy * cr, -sy * sr - cy * sp * cr, cy * cp),
    )
    x, y, z = tables.neck
    for axis in range(3):
        a, b, c = rows[axis]
        transform[axis, 0], transform[axis, 1], transform[axis, 2] = a, b, c
        transform[axis, 3] = tables.neck[axis] - (a * x + b * y + c * z)
        transform[3, axis] = 0.0
    transform[3, 3] = 1.0
