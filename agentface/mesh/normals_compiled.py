"""Vertex normals, single precision; the numpy twins are in :mod:`.normals`."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.kernel import kernel

_ZERO, _ONE = np.float32(0.0), np.float32(1.0)
_SMALLEST = np.float32(1e-36)  # m^4, near the end of single precision


@kernel(fastmath=True, error_model="numpy")
def write_normals(vertices: Floats, triangles: Indices, out: Floats) -> None:
    """Write the area-weighted unit normals of ``vertices (V, 3)`` into ``out (V, 3)``; without any area, zero."""
    for vertex in range(out.shape[0]):
        out[vertex, 0] = _ZERO
        out[vertex, 1] = _ZERO
        out[vertex, 2] = _ZERO
    add_areas(vertices, triangles, out)
    for vertex in range(out.shape[0]):
        make_unit(out, vertex)


@kernel(fastmath=True, error_model="numpy")
def add_areas(vertices: Floats, triangles: Indices, out: Floats) -> None:
    """Add to each corner's row of ``out (V, 3)`` its triangles' normals, as long as twice their areas, m^2."""
    for triangle in range(triangles.shape[0]):
        a, b, c = triangles[triangle, 0], triangles[triangle, 1], triangles[triangle, 2]
        x, y, z = vertices[a, 0], vertices[a, 1], vertices[a, 2]
        ux, uy, uz = vertices[b, 0] - x, vertices[b, 1] - y, vertices[b, 2] - z
        vx, vy, vz = vertices[c, 0] - x, vertices[c, 1] - y, vertices[c, 2] - z
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for corner in (a, b, c):
            out[corner, 0] += nx
            out[corner, 1] += ny
            out[corner, 2] += nz


@kernel(fastmath=True, error_model="numpy")
def make_unit(out: Floats, vertex: int) -> None:
    """Scale a row of ``out (V, 3)`` to length 1; one too short for that becomes zero."""
    square = out[vertex, 0] ** 2 + out[vertex, 1] ** 2 + out[vertex, 2] ** 2
    scale = _ONE / math.sqrt(square) if square > _SMALLEST else _ZERO
    out[vertex, 0] *= scale
    out[vertex, 1] *= scale
    out[vertex, 2] *= scale
