"""The eyes: gaze by angles or to a point, inside the elliptical eye hole (Parke; Bui et al., section 2.3).

The angles are Helmholtz's: both eyes look within one plane, which holds their centres and what they look at.
``gaze_pitch`` raises that plane, ``gaze_yaw`` turns the eyes within it, and ``gaze_vergence`` turns each of them
inward. Three angles so aim two eyes at any point in front of them, each exactly. The muscles have no part in it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from agentface.conventions import SIDES, Floats, Indices, check_finite
from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.parameters import indices_of

FARTHEST = np.float32(0.002)
"""m, the whole thrust of an eye: healthy eyes differ by as much from the mean (exophthalmometry: 16 mm, s.d. 2 mm)."""
WIDEST = np.float32(2.0)
"""By how much a pupil grows or shrinks: from a third of the iris (MPEG-4's neutral face) to 2 and 8 mm of its 12 mm."""
_AXES = "xyz"
_NEAREST = 1e-3  # m in front of the eyes' centres


class EyesTables(NamedTuple):
    """What the turns of the eyes need; angles in radians, and where the parameters stand in a pose."""

    yaw: int
    pitch: int
    vergence: int
    yaw_limit: float
    """Half the width of the eye hole."""
    pitch_limit: float
    """Half its height."""
    thrust: Indices
    """``(2,)``: where the thrusts stand in a pose."""
    dilation: Indices
    """``(2,)``: the dilations of the pupils."""


def prepare(model: HeadModel) -> EyesTables:
    """The tables of a face."""
    yaw, pitch, vergence = (indices_of(name)[0] for name in ("gaze_yaw", "gaze_pitch", "gaze_vergence"))
    limits = math.radians(model.eyes.yaw_limit_deg), math.radians(model.eyes.pitch_limit_deg)
    others = [np.array(indices_of(name), np.int32) for name in ("eye_thrust", "pupil_dilation")]
    return EyesTables(yaw, pitch, vergence, *limits, *others)


def eye_angles(tables: EyesTables, values: Floats, side: int) -> tuple[float, float]:
    """Where the eye of ``side`` (0 left, 1 right) looks: yaw and pitch in radians, kept inside its eye hole.

    The hole is the ellipse (yaw / a)^2 + (pitch / b)^2 = 1; an angle outside is drawn back to it towards the middle.
    """
    inward = float(values[tables.vergence])
    yaw = float(values[tables.yaw]) + (inward if side else -inward)
    pitch = float(values[tables.pitch])
    outside = max(1.0, math.hypot(yaw / tables.yaw_limit, pitch / tables.pitch_limit))
    return yaw / outside, pitch / outside


def apply(tables: EyesTables, values: Floats, rotations: Floats) -> None:
    """Write the turns of both eyes about their centres into ``rotations (2, 3, 3)``, the left eye first."""
    for side in range(len(SIDES)):
        yaw, pitch = eye_angles(tables, values, side)
        cy, sy, cp, sp = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
        rotations[side] = [[cy, 0.0, sy], [-sp * sy, cp, sp * cy], [-cp * sy, -sp, cp * cy]]


def thrust(tables: EyesTables, values: Floats, out: Floats) -> None:
    """Write how far the eyeballs stand forward of where they rest into ``out (2,)`` m."""
    for side in range(len(SIDES)):
        out[side] = FARTHEST * values[tables.thrust[side]]


def dilate(tables: EyesTables, values: Floats, out: Floats) -> None:
    """Write the diameters of the pupils over those at rest into ``out (2,)``: equal steps are equal factors."""
    for side in range(len(SIDES)):
        out[side] = WIDEST ** values[tables.dilation[side]]


def toward(model: HeadModel, point: Sequence[float]) -> tuple[float, float, float]:
    """Yaw, pitch and vergence in radians that aim both eyes at a point, before the eye hole limits them.

    Args:
        model: the face.
        point: x, y, z in metres in the model's axes, where the head is not turned.

    Raises InvalidValueError for a point that is not finite or not in front of the eyes.
    """
    try:
        coordinates = tuple(point)
    except TypeError:
        coordinates = ()
    if len(coordinates) != len(_AXES):
        raise InvalidValueError("point", "x, y and z in metres", point)
    x, y, z = (check_finite(f"point {axis}", value) for axis, value in zip(_AXES, coordinates, strict=True))
    left = model.eye_centre(SIDES[0]).astype(np.float64)
    up, forward = y - left[1], z - left[2]
    if forward < _NEAREST:
        raise InvalidValueError("point z", f"a number above {left[2] + _NEAREST:.3f} (in front of the eyes)", z)
    distance = math.hypot(up, forward)
    of_left, of_right = math.atan2(x - left[0], distance), math.atan2(x + left[0], distance)
    return 0.5 * (of_left + of_right), math.atan2(up, forward), 0.5 * (of_right - of_left)
