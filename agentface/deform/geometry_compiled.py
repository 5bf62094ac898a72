"""One face of many, compiled: :meth:`agentface.deform.geometry.FaceGeometry.__getitem__` for kernels."""

from __future__ import annotations

from agentface.deform.geometry import FaceArrays
from agentface.kernel import kernel


@kernel(error_model="numpy", inline="always")
def face_at(faces: FaceArrays, index: int) -> FaceArrays:
    """The arrays of the face at ``index``; parts of these."""
    return FaceArrays(
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
        faces.shoulders[index],
    )
