"""Waters' linear (vector) muscle: the muscles of a face as arrays, and the displacement of one.

Waters 1987; Bui, Heylen, Nijholt, section 3.1. The radial fall-off carries the factor pi/2 that the latter's
print lost: without it the fall-off is neither 0 at the bone nor 0 at ``fall_finish``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats
from agentface.errors import InvalidValueError, UnknownNameError

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
        falloff: the angular fall-off, see :func:`displacement`.

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
            raise InvalidValueError(f"muscle {self.names[bad]}: {name}", expected, got)

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

    def displacement(self, points: npt.NDArray[np.floating[Any]], muscle: int, contraction: float) -> Doubles:
        """float64 ``(V, 3)`` m: what one muscle adds to all V vertices, now at ``points``."""
        moved = displacement(
            points,
            self.origin[muscle],
            self.insertion[muscle],
            zone=float(self.zone[muscle]),
            fall_start=float(self.fall_start[muscle]),
            fall_finish=float(self.fall_finish[muscle]),
            elasticity=float(self.elasticity[muscle]),
            contraction=contraction,
            falloff=self.falloff,
        )
        scaled: Doubles = self.reach[muscle][:, None] * moved
        return scaled


def displacement(
    points: npt.NDArray[np.floating[Any]],
    origin: npt.NDArray[np.floating[Any]],
    insertion: npt.NDArray[np.floating[Any]],
    *,
    zone: float,
    fall_start: float,
    fall_finish: float,
    elasticity: float,
    contraction: float,
    falloff: Falloff = "smooth",
) -> Doubles:
    """What one vector muscle adds to points, unmasked: ``c k A(alpha) R(D) (v1 - p) / |v1 - p|``.

    ``A`` is 0 outside the zone. Inside it is cos(alpha) for ``"waters"``, faithful, with a cliff of cos(zone) at
    the zone's edge; for ``"smooth"``, our default, it is (cos(alpha) - cos(zone)) / (1 - cos(zone)): 1 on the axis,
    0 at the edge. A point at the origin stays.

    Args:
        points: ``(N, 3)`` m.
        origin: ``(3,)`` m, v1.
        insertion: ``(3,)`` m, v2.
        zone: half angle, rad.
        fall_start: Rs, m.
        fall_finish: Rf, m.
        elasticity: k, m.
        contraction: c in 0..1, or a part of a contraction.
        falloff: ``"smooth"`` or ``"waters"``.

    Returns:
        float64 ``(N, 3)`` m; no row is longer than ``contraction * elasticity``.
    """
    spoke = np.asarray(points, dtype=np.float64) - origin
    axis = np.asarray(insertion, dtype=np.float64) - origin
    axis = axis / np.linalg.norm(axis)
    distance = np.linalg.norm(spoke, axis=1)
    apart = distance > 0.0
    unit = np.divide(spoke, distance[:, None], out=np.zeros_like(spoke), where=apart[:, None])
    strength = angular(unit @ axis, zone, falloff) * radial(distance, fall_start, fall_finish)
    moved: Doubles = -(contraction * elasticity) * strength[:, None] * unit
    return moved


def angular(cosine: Doubles, zone: float, falloff: Falloff = "smooth") -> Doubles:
    """The angular fall-off A in 0..1 of points whose angle from the muscle's axis has this cosine."""
    edge = math.cos(zone)
    inside = cosine if falloff == "waters" else (cosine - edge) / (1.0 - edge)
    return np.where(cosine >= edge, np.clip(inside, 0.0, 1.0), 0.0)


def radial(distance: Doubles, fall_start: float, fall_finish: float) -> Doubles:
    """The radial fall-off R in 0..1: 0 at the origin, 1 at ``fall_start``, 0 from ``fall_finish`` on."""
    rising = 1.0 - distance / fall_start
    falling = (distance - fall_start) / (fall_finish - fall_start)
    inside = np.cos(np.where(distance <= fall_start, rising, falling) * (math.pi / 2))
    return np.where(distance <= fall_finish, inside, 0.0)


def _finite(name: str, values: Any, shape: tuple[int, ...]) -> Doubles:
    array = np.ascontiguousarray(values, dtype=np.float64)
    if array.shape != shape:
        raise InvalidValueError(f"muscles: {name}", f"an array of shape {shape}", array.shape)
    if not np.isfinite(array).all():
        raise InvalidValueError(f"muscles: {name}", "finite numbers", "NaN or infinity")
    return array
