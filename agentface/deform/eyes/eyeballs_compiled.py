"""The turns of the eyes, compiled; the numpy twin is :mod:`agentface.deform.eyes.eyeballs`."""

from __future__ import annotations

import math

from agentface.conventions import Floats
from agentface.deform.eyes import eyeballs
from agentface.deform.eyes.eyeballs import EyesTables
from agentface.kernel import kernel

thrust = kernel(error_model="numpy")(eyeballs.thrust)
dilate = kernel(error_model="numpy")(eyeballs.dilate)


@kernel(error_model="numpy")
def eye_angles(tables: EyesTables, values: Floats, side: int) -> tuple[float, float]:
    """Yaw and pitch in radians of the eye of ``side`` (0 left, 1 right) inside its eye hole."""
    inward = float(values[tables.vergence])
    yaw = float(values[tables.yaw]) + (inward if side else -inward)
    pitch = float(values[tables.pitch])
    outside = max(1.0, math.hypot(yaw / tables.yaw_limit, pitch / tables.pitch_limit))
    return yaw / outside, pitch / outside


@kernel(error_model="numpy")
def apply(tables: EyesTables, values: Floats, rotations: Floats) -> None:
    """Write the turns of both eyes about their centres into ``rotations (2, 3, 3)``."""
    for side in range(2):
        yaw, pitch = eye_angles(tables, values, side)
        cy, sy, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
        turn = rotations[side]
        turn[0, 0], turn[0, 1], turn[0, 2] = cy, 0.0, sy
        turn[1, 0], turn[1, 1], turn[1, 2] = -sp * sy, cp, sp * cy
        turn[2, 0], turn[2, 1], turn[2, 2] = -cp * sy, -sp, cp * cy
