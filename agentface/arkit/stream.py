""":class:`ArkitStream`: ARKit's weights over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.errors import Fault, InvalidValueError
from agentface.head.arkit import ARKIT_SHAPES

ANGLES: tuple[str, ...] = tuple(
    f"{part}{turn}" for part in ("Head", "LeftEye", "RightEye") for turn in ("Yaw", "Pitch", "Roll")
)
"""The nine that Live Link Face writes beside the weights."""


@dataclass(frozen=True, eq=False)
class ArkitStream:
    """Weights of the 52 shapes over time, with the angles of head and eyes.

    Attributes:
        times_s: ``(T,)`` float64, seconds, increasing, the first at least 0; T >= 1.
        weights: ``(T, 52)`` float32, 0..1, in the order of ``ARKIT_SHAPES``.
        angles: ``(T, 9)`` float32, in the order of ``ANGLES``: radians, with Live Link Face's signs; 0 without them.
        rate_hz: frames a second of the recording; None where it is not known.
        name: what its author called it.
        notes: what of the file is left out.

    Raises InvalidValueError for anything else.
    """

    times_s: Doubles
    weights: Floats
    angles: Floats
    rate_hz: float | None = None
    name: str = ""
    notes: tuple[Fault, ...] = ()

    def __post_init__(self) -> None:
        times: Any = np.array(self.times_s, np.float64)
        weights, angles = np.array(self.weights, np.float32), np.array(self.angles, np.float32)
        for name, array, shape in (
            ("times_s", times, (len(times) or 1,)),
            ("weights", weights, (len(times), len(ARKIT_SHAPES))),
            ("angles", angles, (len(times), len(ANGLES))),
        ):
            if array.shape != shape or not np.isfinite(array).all():
                raise InvalidValueError(name, f"finite numbers of shape {shape}", array.shape)
            array.flags.writeable = False
            object.__setattr__(self, name, array)
        if not (times[0] >= 0.0 and (np.diff(times) > 0.0).all()):
            raise InvalidValueError("times_s", "increasing times, 0 or more", times.tolist()[:3])
        if not ((weights >= 0.0) & (weights <= 1.0)).all():
            raise InvalidValueError("weights", "numbers in 0..1", float(weights.max()))

    def __len__(self) -> int:
        return len(self.times_s)
