"""Numbers read off a face, compiled; the numpy twin is :mod:`agentface.mpeg4.readings`."""

from __future__ import annotations

from agentface.conventions import Doubles
from agentface.deform.geometry import FaceArrays
from agentface.kernel import kernel
from agentface.mpeg4.readings import Kind, Readings

_SKIN, _BONE = int(Kind.SKIN), int(Kind.BONE)


@kernel(error_model="numpy")
def read(readings: Readings, face: FaceArrays, out: Doubles) -> None:
    """Write the numbers of one face into ``out (N,)``."""
    jaw = face.jaw
    for row in range(out.shape[0]):
        kind, vertex, axis = readings.kind[row], readings.vertex[row], readings.axis[row]
        if kind == _BONE:
            place = jaw[axis, 3] + 0.0 * readings.rest[row]
            for k in range(3):
                place += jaw[axis, k] * readings.bone[vertex, k]
        elif kind == _SKIN:
            place = _below(face, vertex, axis)
        else:
            place = 0.0 * readings.rest[row]
            for k in range(3):
                place += jaw[k, axis] * (_below(face, vertex, k) - jaw[k, 3])
        out[row] = readings.scale[row] * (place - readings.rest[row])


@kernel(error_model="numpy", inline="always")
def _below(face: FaceArrays, vertex: int, axis: int) -> float:
    """Where the skin is below its wrinkles, in double precision."""
    return 1.0 * face.vertices[vertex, axis] - 1.0 * face.wrinkles[vertex] * face.smooth_normals[vertex, axis]
