"""The vector muscles of a face as arrays."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats
from agentface.errors import InvalidValueError, Place, UnknownNameError

Falloff: TypeAlias = Literal["smooth", "waters"]
FALLOFFS: tuple[Falloff, ...] = ("smooth", "waters")


@dataclass(frozen=True, slots=True, eq=False)
class MuscleSet:
    """The M vector muscles of a face with V vertices, a structure of arrays.

    Args:
        names: M names.
        origin: float64 ``(M, 3)`` m, the attachment to the bone (v1), which a contraction pulls toward.
        insertion: float64 ``(M, 3)`` m, the attachment to the skin (v2); it gives the zone its axis.
        zone: float64 ``(M,)`` rad in 0..pi/2, half the angle of the zone of influence.
        fall_start: float64 ``(M,)`` m, distance from the origin of the largest displacement (Rs).
        fall_finish: float64 ``(M,)`` m, distance from the origin where it ends (Rf), beyond ``fall_start``.
        elasticity: float64 ``(M,)`` m, the largest displacement at full contraction (k).
        reach: float32 ``(M, V)`` in 0..1, how far each muscle may move each vertex; 0 is the paper's
            cut-off by region (section 5), values between soften the region's border.
        falloff: the angular fall-off, see :func:`agentface.deform.muscles.vector_muscle.displacement`.

    Raises:
        InvalidValueError: for a wrong shape, a number that is not finite or out of range, or an unknown fall-off.
    """

    names: Sequence[str]
    origin: Doubles
    insertion: Doubles
    zone: Doubles
    fall_start: Doubles
    fall_finish: Doubles
    elasticity: Doubles
    reach: Floats
    falloff: Falloff = "smooth"

    def __post_init__(self) -> None:
        count = len(self.names)
        object.__setattr__(self, "names", tuple(self.names))
        for name in ("origin", "insertion"):
            object.__setattr__(self, name, _finite(name, getattr(self, name), (count, 3)))
        for name in ("zone", "fall_start", "fall_finish", "elasticity"):
            object.__setattr__(self, name, _finite(name, getattr(self, name), (count,)))
        vertices = np.shape(self.reach)[-1] if np.ndim(self.reach) else 0
        reach = _finite("reach", self.reach, (count, vertices))
        object.__setattr__(self, "reach", np.ascontiguousarray(reach, dtype=np.float32))
        self._check_ranges()

    def _check_ranges(self) -> None:
        length = np.linalg.norm(self.insertion - self.origin, axis=1)
        self._check("insertion", length > 0.0, "a point apart from the origin", self.insertion)
        self._check("zone", (self.zone > 0.0) & (self.zone <= math.pi / 2), "a half angle in 0..pi/2 rad", self.zone)
        self._check("fall_start", self.fall_start > 0.0, "a distance above 0 m", self.fall_start)
        beyond = self.fall_finish > self.fall_start
        self._check("fall_finish", beyond, "a distance beyond fall_start", self.fall_finish)
        self._check("elasticity", self.elasticity >= 0.0, "a displacement of 0 m or more", self.elasticity)
        within = ((self.reach >= 0.0) & (self.reach <= 1.0)).all(axis=1)
        self._check("reach", within, "weights in 0..1", self.reach)
        if self.falloff not in FALLOFFS:
            raise UnknownNameError("fall-off", self.falloff, FALLOFFS)

    def _check(self, name: str, good: Any, expected: str, values: npt.NDArray[Any]) -> None:
        if not good.all():
            bad = int(np.flatnonzero(~good)[0])
            value = values[bad]
            got = value.tolist() if value.size <= 3 else f"{value.min():g}..{value.max():g}"
            place = Place("muscles.yaml", ("muscles", self.names[bad][:-2], name))
            raise InvalidValueError(f"muscle {self.names[bad]}: {name}", expected, got, place=place)

    def __len__(self) -> int:
        return len(self.names)

    @property
    def vertex_count(self) -> int:
        """How many vertices the face has."""
        return int(self.reach.shape[1])

    @property
    def axis(self) -> Doubles:
        """float64 ``(M, 3)``, unit vectors from origin to insertion."""
        along = self.insertion - self.origin
        unit: Doubles = along / np.linalg.norm(along, axis=1, keepdims=True)
        return unit

    def index(self, name: str) -> int:
        """The row of a muscle; raises UnknownNameError."""
        try:
            return list(self.names).index(name)
        except ValueError:
            raise UnknownNameError("vector muscle", name, self.names) from None


def _finite(name: str, values: Any, shape: tuple[int, ...]) -> Doubles:
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.shape != shape:
        raise InvalidValueError(f"muscles: {name}", f"an array of shape {shape}", array.shape)
    if not np.isfinite(array).all():
        raise InvalidValueError(f"muscles: {name}", "finite numbers", "NaN or infinity")
    return array
