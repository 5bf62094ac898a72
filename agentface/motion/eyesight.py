"""Where eyes in a turned head have to turn to see a point."""

from __future__ import annotations

import math
from typing import NamedTuple, Self

from agentface.conventions import SIDES
from agentface.head.model import HeadModel
from agentface.parameters import parameter

Point = tuple[float, float, float]
_NEAREST = 1e-3  # m in front of the eyes' centres
_FREE = 0.9
"""So much of its range an angle goes through as it is; beyond, it comes to its limit ever more slowly."""
_REACH = 0.98
"""So much of its range an angle reaches: the rest is for what eyes do besides, lest that is cut off at a corner."""
_EYES = (parameter(name) for name in ("gaze_yaw", "gaze_pitch", "gaze_vergence"))
_LIMITS = tuple((_REACH * known.low, _REACH * known.high) for known in _EYES)


class Eyesight(NamedTuple):
    """What of a face says how it sees.

    Attributes:
        eye: the centre of the left eye, in metres; the right one's is its mirror image.
        neck: about which the head turns.
        hole: half the width and half the height of the eye hole, in radians.
    """

    eye: Point
    neck: Point
    hole: tuple[float, float]

    @classmethod
    def of(cls, model: HeadModel) -> Self:
        """That of a face."""
        from agentface.deform.finish.head_turn import prepare

        eye, neck = (tuple(map(float, point)) for point in (model.eye_centre(SIDES[0]), prepare(model).neck))
        return cls(eye, neck, (math.radians(model.eyes.yaw_limit_deg), math.radians(model.eyes.pitch_limit_deg)))  # type: ignore[arg-type]

    def in_head(self, point: Point, yaw: float, pitch: float, roll: float) -> Point:
        """A point in the axes of a head that is turned, by :mod:`agentface.deform.finish.head_turn`'s angles."""
        nx, ny, nz = self.neck
        x, y, z = point[0] - nx, point[1] - ny, point[2] - nz
        c, s = math.cos(yaw), math.sin(yaw)
        x, z = c * x - s * z, s * x + c * z
        c, s = math.cos(pitch), math.sin(pitch)
        y, z = c * y - s * z, s * y + c * z
        c, s = math.cos(roll), math.sin(roll)
        x, y = c * x - s * y, s * x + c * y
        return x + nx, y + ny, z + nz

    def toward(self, point: Point, yaw: float = 0.0, pitch: float = 0.0, roll: float = 0.0) -> Point:
        """Yaw, pitch and vergence in radians that would aim both eyes of a turned head at ``point``."""
        x, y, z = self.in_head(point, yaw, pitch, roll)
        ex, ey, ez = self.eye
        up, forward = y - ey, max(z - ez, _NEAREST)
        distance = math.hypot(up, forward)
        left, right = math.atan2(x - ex, distance), math.atan2(x + ex, distance)
        return 0.5 * (left + right), math.atan2(up, forward), 0.5 * (right - left)

    def aim(self, point: Point, yaw: float = 0.0, pitch: float = 0.0, roll: float = 0.0) -> Point:
        """The same as far as eyes turn: exact up to 0.9 of each range; to its end an angle comes without a kink."""
        wanted = self.toward(point, yaw, pitch, roll)
        return tuple(_kept(angle, low, high) for angle, (low, high) in zip(wanted, _LIMITS, strict=True))  # type: ignore[return-value]


def _kept(angle: float, low: float, high: float) -> float:
    limit = high if angle >= 0.0 else -low
    over = abs(angle) / limit - _FREE
    if over <= 0.0:
        return angle
    return math.copysign(limit * (_FREE + (1.0 - _FREE) * math.tanh(over / (1.0 - _FREE))), angle)
