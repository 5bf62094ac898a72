"""Readings of many faces, compiled; the numpy twin is in :mod:`agentface.mpeg4.meter`."""

from __future__ import annotations

from agentface.conventions import Doubles
from agentface.deform.geometry import FaceArrays
from agentface.kernel import kernel
from agentface.mpeg4.readings import Readings
from agentface.mpeg4.readings_compiled import read


@kernel(error_model="numpy")
def read_faces(readings: Readings, faces: FaceArrays, out: Doubles) -> None:
    """Write the numbers of ``B`` faces into ``out (B, N)``."""
    for index in range(out.shape[0]):
        face = FaceArrays(
            faces.vertices[index],
            faces.normals[index],
            faces.wrinkles[index],
            faces.eye_rotations[index],
            faces.jaw[index],
            faces.head[index],
            faces.smooth_normals[index],
            faces.wrinkle_levels[index],
            faces.tongue[index],
            faces.pupils[index],
            faces.eye_thrust[index],
        )
        read(readings, face, out[index])
