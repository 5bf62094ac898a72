"""Numbers read off a face, compiled; the numpy twin is :mod:`agentface.mpeg4.readings`."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.geometry import FaceArrays
from agentface.kernel import kernel
from agentface.mpeg4.readings import Kind, Readings

_SKIN, _IN_JAW, _BONE = int(Kind.SKIN), int(Kind.IN_JAW), int(Kind.BONE)
_TONGUE, _ROLL, _PUPIL = int(Kind.TONGUE), int(Kind.ROLL), int(Kind.PUPIL)


@kernel(error_model="numpy")
def read(readings: Readings, face: FaceArrays, out: Doubles) -> None:
    """Write the numbers of one face into ``out (N,)``."""
    jaw = face.jaw
    for row in range(out.shape[0]):
        kind, vertex, axis = readings.kind[row], readings.vertex[row], readings.axis[row]
        place = 0.0
        if kind == _SKIN:
            place += _below(face, vertex, axis)
        elif kind == _IN_JAW:
            for k in range(3):
                place += jaw[k, axis] * (_below(face, vertex, k) - jaw[k, 3])
        elif kind == _BONE:
            place += jaw[axis, 3]
            for k in range(3):
                place += jaw[axis, k] * readings.bone[vertex, k]
        elif kind == _TONGUE:
            place += face.tongue[vertex, axis]
        elif kind == _ROLL:
            place += _rolled(readings.roll, face.tongue)
        elif kind == _PUPIL:
            place += face.pupils[vertex]
        else:
            place += face.eye_thrust[vertex]
        out[row] = readings.scale[row] * (place - readings.rest[row])


@kernel(error_model="numpy", inline="always")
def _below(face: FaceArrays, vertex: int, axis: int) -> float:
    """Where the skin is below its wrinkles, in double precision."""
    return 1.0 * face.vertices[vertex, axis] - 1.0 * face.wrinkles[vertex] * face.smooth_normals[vertex, axis]


@kernel(error_model="numpy")
def _rolled(roll: Indices, tongue: Floats) -> float:
    """The angle from the tongue's middle up to its borders."""
    left, right, middle = roll[0], roll[1], roll[2]
    up = 0.5 * (np.float64(tongue[left, 1]) + np.float64(tongue[right, 1])) - np.float64(tongue[middle, 1])
    return math.atan2(up, 0.5 * (np.float64(tongue[left, 0]) - np.float64(tongue[right, 0])))
