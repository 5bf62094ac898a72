"""The normals of a mesh's vertices."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats, Indices


def vertex_normals(vertices: Floats | Doubles, triangles: Indices) -> Floats:
    """``(V, 3)`` unit normals: the mean of the triangles' normals, weighted by area."""
    a, b, c = (vertices[triangles[:, corner]] for corner in range(3))
    faces = np.cross(b - a, c - a)
    corners, weights = triangles.T.ravel(), np.tile(faces, (3, 1))
    sums = np.stack([np.bincount(corners, weights[:, axis], len(vertices)) for axis in range(3)], axis=1)
    length = np.linalg.norm(sums, axis=1, keepdims=True)
    return np.asarray(sums / np.maximum(length, 1e-12), np.float32)
