"""Texture coordinates of a face whose mesh has none: the skin spread out flat without a seam.

Every vertex is seen from a point in the head, and its direction is mapped by Lambert's azimuthal equal-area projection
about the front (J. P. Snyder, Map Projections: A Working Manual, USGS Professional Paper 1395, 1987, chapter 24).
The back of the head, where that projection is singular, is left out, so that the face gets the more of the picture.
"""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.landmarks import Landmarks

# Eye separations below and behind the pupils: there lips, nostrils, lids, ears and neck fold over little.
_BELOW, _BEHIND = 0.5, 1.6
_RIM = math.radians(120)  # from the front: the picture's rim
_FADE = math.radians(105)  # from here to the rim the picture fades


def unwrap_centre(landmarks: Landmarks) -> Doubles:
    """``(3,)`` m: the point from which :func:`unwrap` looks, in the median plane between the ears."""
    pupils = 0.5 * (landmarks["pupil_l"].astype(np.float64) + landmarks["pupil_r"])
    return np.asarray(pupils - landmarks.eye_separation * np.array([0.0, _BELOW, _BEHIND]))


def unwrap(vertices: Floats, centre: Doubles) -> Floats:
    """``(V, 2)`` float32 0..1: u to the person's left, which is the picture's right, and v from the top down.

    Args:
        vertices: ``(V, 3)`` m.
        centre: ``(3,)`` m, in the head, in the median plane.

    The front is at (0.5, 0.5); what lies behind the rim is on it, a circle of radius 0.5. Mirrored vertices have
    mirrored u.
    """
    away = vertices - centre
    sideways, from_front = _polar(away)
    radius = 0.5 * np.minimum(np.sin(0.5 * from_front) / math.sin(0.5 * _RIM), 1.0)
    direction = away[:, :2] / np.where(sideways > 0.0, sideways, 1.0)[:, None]
    uv = 0.5 + radius[:, None] * direction * [1.0, -1.0]
    return np.asarray(np.clip(uv, 0.0, 1.0), np.float32)


def unwrap_cover(vertices: Floats, centre: Doubles) -> Floats:
    """``(V,)`` float32 0..1: how much of the picture ``vertices`` show: 1 on the face, 0 from the rim backward."""
    _, from_front = _polar(vertices - centre)
    part = np.clip((_RIM - from_front) / (_RIM - _FADE), 0.0, 1.0)
    return np.asarray(part * part * (3.0 - 2.0 * part), np.float32)


def _polar(away: Doubles) -> tuple[Doubles, Doubles]:
    """The distances from the axis through the front in metres, and the angles from the front 0..pi."""
    sideways = np.hypot(away[:, 0], away[:, 1])
    return sideways, np.arctan2(sideways, away[:, 2])
