"""Vertex normals: the mean of the normals of the triangles around a vertex, weighted by their areas."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices


def doubled_areas(vertices: npt.NDArray[np.floating[Any]], triangles: npt.NDArray[np.integer[Any]]) -> Doubles:
    """float64 ``(T, 3)``: along each triangle's normal, outward, as long as twice its area."""
    corners = np.asarray(vertices, dtype=np.float64)[triangles]
    return np.asarray(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))


def vertex_normals(vertices: npt.NDArray[np.floating[Any]], triangles: npt.NDArray[np.integer[Any]]) -> Doubles:
    """float64 unit ``(V, 3)``, outward.

    Args:
        vertices: ``(V, 3)``.
        triangles: ``(T, 3)`` vertex indices, counter-clockwise seen from outside.

    Returns:
        Outward unit normals; zero where a vertex has no triangle or its triangles have no area.
    """
    across = doubled_areas(vertices, triangles)
    ends = triangles.ravel()
    total = np.stack([np.bincount(ends, across[:, axis].repeat(3), len(vertices)) for axis in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    normals: Doubles = np.divide(total, length, out=np.zeros_like(total), where=length > 0.0)
    return normals


def write_normals(vertices: Floats, triangles: Indices, out: Floats) -> None:
    """Write :func:`vertex_normals` into ``out``, float32 ``(V, 3)``."""
    out[:] = vertex_normals(vertices, triangles)


def corner_normals(
    vertices: npt.NDArray[np.floating[Any]],
    triangles: npt.NDArray[np.integer[Any]],
    on_inner_foot: npt.NDArray[np.bool_],
) -> Doubles:
    """float64 unit ``(T, 3, 3)``: the normals that shade each corner of each triangle (Bui et al., section 4).

    The mean normal of a vertex at the bottom between two wrinkles points straight out of the skin and hides the
    valley; there, each triangle uses its own normal.

    Args:
        vertices: ``(V, 3)``, raised.
        triangles: ``(T, 3)`` vertex indices.
        on_inner_foot: ``(V,)``, see :func:`agentface.head.trains.inner_feet`.
    """
    across = doubled_areas(vertices, triangles)
    length = np.linalg.norm(across, axis=1, keepdims=True)
    flat = np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)
    shading: Doubles = vertex_normals(vertices, triangles)[triangles]
    return np.where(on_inner_foot[triangles][:, :, None], flat[:, None, :], shading)
