"""Numbers read off a face: places of single points along an axis, less those at rest.

Skin is read below its wrinkles, v - h n, along the smooth normals n: they rise by the light's needs, not by a
muscle's. A point of the jaw's bone is where the jaw carries it; skin can also be read in the jaw's frame, as what it
does besides.
"""

from __future__ import annotations

from enum import IntEnum
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.deform.geometry import FaceArrays


class Kind(IntEnum):
    """What is read."""

    SKIN = 0
    """A vertex of the skin."""
    IN_JAW = 1
    """A vertex of the skin in the jaw's frame."""
    BONE = 2
    """A point that the jaw carries."""


class Readings(NamedTuple):
    """N numbers, y = scale (place - rest).

    Attributes:
        kind: ``(N,)`` int32, of :class:`Kind`.
        vertex: ``(N,)`` int32, of the skin, or a row of ``bone``.
        axis: ``(N,)`` int32, 0 to 2.
        scale: ``(N,)`` float64, units a metre, with the sign of the direction.
        rest: ``(N,)`` float64 m.
        bone: ``(Q, 3)`` float64 m, points of the jaw at rest.
    """

    kind: Indices
    vertex: Indices
    axis: Indices
    scale: Doubles
    rest: Doubles
    bone: Doubles


def read(readings: Readings, face: FaceArrays, out: Doubles) -> None:
    """Write the numbers of one face into ``out (N,)``."""
    turn, shift = face.jaw[:3, :3].astype(np.float64), face.jaw[:3, 3].astype(np.float64)
    on_skin = readings.kind != Kind.BONE
    vertex = readings.vertex[on_skin]
    heights = face.wrinkles[vertex].astype(np.float64)[:, None]
    places = np.empty((len(readings.kind), 3))
    places[on_skin] = face.vertices[vertex] - heights * face.smooth_normals[vertex]
    places[~on_skin] = readings.bone[readings.vertex[~on_skin]] @ turn.T + shift
    in_jaw = readings.kind == Kind.IN_JAW
    places[in_jaw] = (places[in_jaw] - shift) @ turn
    out[:] = readings.scale * (np.take_along_axis(places, readings.axis[:, None], axis=1)[:, 0] - readings.rest)
