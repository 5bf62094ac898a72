"""Readings of many faces, compiled; the numpy twin is in :mod:`agentface.mpeg4.meter`."""

from __future__ import annotations

from agentface.conventions import Doubles
from agentface.deform.geometry import FaceArrays
from agentface.deform.geometry_compiled import face_at
from agentface.kernel import kernel
from agentface.mpeg4.readings import Readings
from agentface.mpeg4.readings_compiled import read


@kernel(error_model="numpy")
def read_faces(readings: Readings, faces: FaceArrays, out: Doubles) -> None:
    """Write the numbers of ``B`` faces into ``out (B, N)``."""
    for index in range(out.shape[0]):
        read(readings, face_at(faces, index), out[index])
