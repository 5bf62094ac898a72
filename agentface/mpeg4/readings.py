"""Numbers read off a face: places of single points along an axis, less those at rest.

Skin is read below its wrinkles, v - h n, along the smooth normals n: they rise by the light's needs, not by a
muscle's. A point of the jaw's bone is where the jaw carries it; skin can also be read in the jaw's frame, as what it
does besides.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.geometry import FaceArrays


class Kind(IntEnum):
    """What is read."""

    SKIN = 0
    """A vertex of the skin."""
    IN_JAW = 1
    """A vertex of the skin in the jaw's frame."""
    BONE = 2
    """A point that the jaw carries."""
    TONGUE = 3
    """A vertex of the tongue in the jaw's frame."""
    ROLL = 4
    """The angle in radians by which the borders of the tongue stand above its middle."""
    PUPIL = 5
    """The diameter of a pupil over that at rest."""
    EYEBALL = 6
    """How far an eyeball stands forward, in metres."""


class Readings(NamedTuple):
    """N numbers, y = scale (place - rest).

    Attributes:
        kind: ``(N,)`` int32, of :class:`Kind`.
        vertex: ``(N,)`` int32, of the skin or the tongue, a row of ``bone``, or a side, 0 left and 1 right.
        axis: ``(N,)`` int32, 0 to 2; 0 for what has none.
        scale: ``(N,)`` float64, units a metre, a radian or a diameter, with the sign of the direction.
        rest: ``(N,)`` float64 m, rad, or diameters.
        bone: ``(Q, 3)`` float64 m, points of the jaw at rest.
        roll: ``(3,)`` int32, the vertices of the tongue's left and right border and of its middle.
    """

    kind: Indices
    vertex: Indices
    axis: Indices
    scale: Doubles
    rest: Doubles
    bone: Doubles
    roll: Indices


def read(readings: Readings, face: FaceArrays, out: Doubles) -> None:
    """Write the numbers of one face into ``out (N,)``."""
    turn, shift = face.jaw[:3, :3].astype(np.float64), face.jaw[:3, 3].astype(np.float64)
    of = {kind: readings.kind == kind for kind in Kind}
    on_skin = of[Kind.SKIN] | of[Kind.IN_JAW]
    vertex = readings.vertex[on_skin]
    heights = face.wrinkles[vertex].astype(np.float64)[:, None]
    places = np.zeros((len(readings.kind), 3))
    places[on_skin] = face.vertices[vertex] - heights * face.smooth_normals[vertex]
    places[of[Kind.BONE]] = readings.bone[readings.vertex[of[Kind.BONE]]] @ turn.T + shift
    places[of[Kind.TONGUE]] = face.tongue[readings.vertex[of[Kind.TONGUE]]]
    places[of[Kind.ROLL], 0] = rolled(readings.roll, face.tongue)
    places[of[Kind.PUPIL], 0] = face.pupils[readings.vertex[of[Kind.PUPIL]]]
    places[of[Kind.EYEBALL], 0] = face.eye_thrust[readings.vertex[of[Kind.EYEBALL]]]
    in_jaw = readings.kind == Kind.IN_JAW
    places[in_jaw] = (places[in_jaw] - shift) @ turn
    out[:] = readings.scale * (np.take_along_axis(places, readings.axis[:, None], axis=1)[:, 0] - readings.rest)


def rolled(roll: Indices, tongue: Floats) -> float:
    """The angle in radians, seen from before, from the tongue's middle up to its borders: the mean of both sides."""
    left, right, middle = (tongue[vertex].astype(np.float64) for vertex in roll)
    up = 0.5 * (left[1] + right[1]) - middle[1]
    return float(np.arctan2(up, 0.5 * (left[0] - right[0])))
