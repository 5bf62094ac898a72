"""The range of every parameter, held against a whole pose, or many, at once."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.errors import InvalidValueError
from agentface.parameters import PARAMETERS

# A limit is a number of single precision: a pose that FacePose.replace took lies within it, rounded or not.
_LOW = np.array([known.low for known in PARAMETERS], np.float32)
_HIGH = np.array([known.high for known in PARAMETERS], np.float32)


def check_pose(values: Floats) -> None:
    """Raise InvalidValueError, naming the first parameter, unless ``values (COUNT,)`` lie within their ranges."""
    if np.count_nonzero((values >= _LOW) & (values <= _HIGH)) != len(values):  # a frame's time: faster than all()
        raise _refusal(values)


def check_poses(values: Floats) -> None:
    """As :func:`check_pose` for ``(B, COUNT)``; the error also names the pose."""
    good = ((values >= _LOW) & (values <= _HIGH)).all(axis=1)
    if not good.all():
        pose = int(np.argmin(good))
        raise _refusal(values[pose], f"pose {pose}: ")


def _refusal(values: Floats, before: str = "") -> InvalidValueError:
    index = int(np.argmin((values >= _LOW) & (values <= _HIGH)))
    known, got = PARAMETERS[index], float(values[index])
    what, unit = ("angle", " rad") if known.unit == "rad" else ("contraction", "")
    expected = f"a number in {known.low:g}..{known.high:g}{unit}" if np.isfinite(got) else "a finite number"
    return InvalidValueError(f"{before}{what} of {known.name}", expected, got)
