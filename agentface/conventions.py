"""Axes, units, shapes and dtypes, and the checks that hold them.

Axes are those of glTF: right-handed, +Y up, the face looks along +Z, the person's left is +X.
Metres, seconds, radians; degrees only in YAML and where a name says ``_deg``.
Arrays are float32 in C order, ``(V, 3)``; intensities, contractions and weights lie in 0..1.
Names of paired muscles end in ``_l`` and ``_r``, the person's left and right.
"""

from __future__ import annotations

import math
from typing import Any, TypeAlias, TypeVar

import numpy as np
import numpy.typing as npt

from agentface.errors import InvalidValueError

Floats: TypeAlias = npt.NDArray[np.float32]
Doubles: TypeAlias = npt.NDArray[np.float64]
Indices: TypeAlias = npt.NDArray[np.int32]
Bytes: TypeAlias = npt.NDArray[np.uint8]

SIDES = ("l", "r")
FASTEST_HZ = 1000.0
"""No frames come faster."""
ROUNDING = 1e-6
"""How far outside of its range a number is taken to be by rounding, in parts of the larger limit.

Eight steps of single precision at 1, what is left of a few sums and products; far less than can be seen.
"""


_Array = TypeVar("_Array", bound=npt.NDArray[Any])


def read_only(array: _Array) -> _Array:
    """The same numbers, not to be written, as a pose's are: kernels are compiled for these and for others apart."""
    seen = array.view()
    seen.flags.writeable = False
    return seen


def check_fraction(where: str, value: Any) -> float:
    """``value`` as a float in 0..1; raises InvalidValueError for anything else, NaN included."""
    return check_range(where, value, 0.0, 1.0)


def check_range(where: str, value: Any, low: float, high: float) -> float:
    """``value`` as a finite float in ``low..high``; raises InvalidValueError for anything else.

    What is outside by no more than ``ROUNDING`` becomes the limit.
    """
    number = check_finite(where, value)
    slack = ROUNDING * max(abs(low), abs(high))
    if not low - slack <= number <= high + slack:
        raise InvalidValueError(where, f"a number in {low:g}..{high:g}", value)
    return float(min(max(number, low), high))


def check_finite(where: str, value: Any) -> float:
    """``value`` as a finite float; raises InvalidValueError for anything else."""
    if isinstance(value, (bool, str, bytes)):
        raise InvalidValueError(where, "a number", value)
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise InvalidValueError(where, "a number", value) from None
    if not math.isfinite(number):
        raise InvalidValueError(where, "a finite number", value)
    return number


def check_duration(where: str, value: Any) -> float:
    """``value`` as a number of seconds, zero or more."""
    number = check_finite(where, value)
    if number < 0.0:
        raise InvalidValueError(where, "a number of seconds, zero or more", value)
    return number


def check_rate(where: str, value: Any) -> float:
    """``value`` as a number a second, more than 0 and at most ``FASTEST_HZ``; raises InvalidValueError."""
    number = check_finite(where, value)
    if not 0.0 < number <= FASTEST_HZ:
        raise InvalidValueError(where, f"a number a second, more than 0 and at most {FASTEST_HZ:g}", value)
    return number


def check_vertices(where: str, array: Any) -> Floats:
    """``array`` as finite float32 ``(V, 3)`` in C order."""
    vertices = np.ascontiguousarray(array, dtype=np.float32)
    if vertices.ndim != 2 or vertices.shape[1] != 3:
        raise InvalidValueError(where, "an array of shape (V, 3)", vertices.shape)
    if not np.isfinite(vertices).all():
        bad = int(np.flatnonzero(~np.isfinite(vertices).all(axis=1))[0])
        raise InvalidValueError(where, "finite coordinates", f"{vertices[bad].tolist()} at vertex {bad}")
    return vertices
