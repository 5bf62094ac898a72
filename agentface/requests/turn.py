"""Turn eyes and head."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass

from agentface.conventions import check_duration, check_finite
from agentface.errors import InvalidValueError
from agentface.motion.eyesight import Eyesight
from agentface.parameters import check_degrees
from agentface.requests.request import Movable, Request

GAZE_FADE_S = 0.06
"""A saccade."""
HEAD_FADE_S = 0.4


@dataclass(frozen=True, slots=True)
class SetGaze(Request):
    """Look far away: ``yaw_deg`` to the person's left (-50..50), ``pitch_deg`` up (-40..40), in ``fade`` seconds."""

    yaw_deg: float
    pitch_deg: float
    fade: float = GAZE_FADE_S

    def __post_init__(self) -> None:
        self._keep(
            yaw_deg=check_degrees("gaze_yaw", self.yaw_deg),
            pitch_deg=check_degrees("gaze_pitch", self.pitch_deg),
            fade=check_duration("fade", self.fade),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """The eyes look at one thing."""
        return ("gaze",)

    def apply(self, face: Movable) -> None:
        """Tell the gaze's channel."""
        face.channels.gaze.turn((math.radians(self.yaw_deg), math.radians(self.pitch_deg), 0.0), self.fade)


@dataclass(frozen=True, slots=True)
class LookAt(Request):
    """Look at a point, each eye exactly.

    Attributes:
        x, y, z: metres in the model's axes, where the head is not turned: to the person's left, up, forward.
        fade: what the eyes take, in seconds, those of a leap so far when None; the head takes its own time. With 0
            both are there at once.

    The eyes stay on the point while the head turns. If it is too far aside for the eyes, the head joins them; beyond
    both ranges they go as far as they can. Which points are in front of the eyes is the face's to
    say: applied to a face, a point that is not raises InvalidValueError.
    """

    x: float
    y: float
    z: float
    fade: float | None = None

    def __post_init__(self) -> None:
        axes = {axis: check_finite(f"point {axis}", getattr(self, axis)) for axis in ("x", "y", "z")}
        self._keep(**axes, fade=None if self.fade is None else check_duration("fade", self.fade))

    @classmethod
    def of(cls, point: Sequence[float], fade: float | None = None) -> LookAt:
        """The request for a point of three coordinates; raises InvalidValueError for anything else."""
        try:
            x, y, z = point
        except (TypeError, ValueError):
            raise InvalidValueError("point", "x, y and z in metres", point) from None
        return cls(x, y, z, fade)

    @property
    def key(self) -> tuple[Hashable, ...]:
        """The eyes look at one thing."""
        return ("gaze",)

    def apply(self, face: Movable) -> None:
        """Tell the gaze's channel."""
        from agentface.deform.eyes.eyeballs import toward

        point = (self.x, self.y, self.z)
        toward(face.model, point)  # raises for one that is not in front of the eyes
        face.channels.gaze.look_at(Eyesight.of(face.model), point, self.fade)


@dataclass(frozen=True, slots=True)
class SetHead(Request):
    """Turn the head, in ``fade`` seconds: to its left (-80..80 degrees), up (-60..60), tilted to its left (-50..50)."""

    yaw_deg: float
    pitch_deg: float
    roll_deg: float = 0.0
    fade: float = HEAD_FADE_S

    def __post_init__(self) -> None:
        self._keep(
            yaw_deg=check_degrees("head_yaw", self.yaw_deg),
            pitch_deg=check_degrees("head_pitch", self.pitch_deg),
            roll_deg=check_degrees("head_roll", self.roll_deg),
            fade=check_duration("fade", self.fade),
        )

    def apply(self, face: Movable) -> None:
        """Tell the head's channel."""
        degrees = (self.yaw_deg, self.pitch_deg, self.roll_deg)
        face.channels.head.turn(tuple(math.radians(angle) for angle in degrees), self.fade)
