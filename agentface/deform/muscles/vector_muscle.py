"""Waters' linear (vector) muscle: the muscles of a face as arrays, and the displacement of one.

Waters 1987; Bui, Heylen, Nijholt, section 3.1. The radial fall-off carries the factor pi/2 that the latter's
print lost: without it the fall-off is neither 0 at the bone nor 0 at ``fall_finish``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.head.muscle_set import Falloff, MuscleSet

NOTHING = 1e-6
"""A contraction as small as this is none: 0.6 in single precision is three steps of 0.2, not four."""


def pull(muscles: MuscleSet, muscle: int, points: npt.NDArray[np.floating[Any]], contraction: float) -> Doubles:
    """float64 ``(V, 3)`` m: what one muscle adds to all V vertices of a face, now at ``points``."""
    moved = displacement(
        points,
        muscles.origin[muscle],
        muscles.insertion[muscle],
        zone=float(muscles.zone[muscle]),
        fall_start=float(muscles.fall_start[muscle]),
        fall_finish=float(muscles.fall_finish[muscle]),
        elasticity=float(muscles.elasticity[muscle]),
        contraction=contraction,
        falloff=muscles.falloff,
    )
    scaled: Doubles = muscles.reach[muscle][:, None] * moved
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
