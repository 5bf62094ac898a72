"""Vertex normals: the mean of the normals of the triangles around a vertex, weighted by their areas."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.errors import InvalidValueError


def vertex_normals(vertices: npt.NDArray[np.floating[Any]], triangles: npt.NDArray[np.integer[Any]]) -> Doubles:
    """The numpy form, in double precision: float64 unit ``(V, 3)``.

    Args:
        vertices: ``(V, 3)``.
        triangles: ``(T, 3)`` vertex indices, counter-clockwise seen from outside.

    Returns:
        Outward unit normals; zero where a vertex has no triangle or its triangles have no area.
    """
    corners = np.asarray(vertices, dtype=np.float64)[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    total = np.zeros((len(vertices), 3))
    np.add.at(total, triangles, across[:, None, :])
    length = np.linalg.norm(total, axis=1, keepdims=True)
    normals: Doubles = np.divide(total, length, out=np.zeros_like(total), where=length > 0.0)
    return normals


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
    corners = np.asarray(vertices, dtype=np.float64)[triangles]
    across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(across, axis=1, keepdims=True)
    flat = np.divide(across, length, out=np.zeros_like(across), where=length > 0.0)
    shading: Doubles = vertex_normals(vertices, triangles)[triangles]
    return np.where(on_inner_foot[triangles][:, :, None], flat[:, None, :], shading)


class NormalField:
    """The normals of one mesh, whatever its vertices do, by a compiled kernel.

    Args:
        triangles: ``(T, 3)`` vertex indices below ``vertex_count``.
        vertex_count: V.
        compiled: False for the numpy form, which starts at once and is slower.

    Raises:
        InvalidValueError: for triangles of another shape, or that name a vertex that does not exist.
    """

    def __init__(self, triangles: npt.NDArray[np.integer[Any]], vertex_count: int, *, compiled: bool = True) -> None:
        if triangles.ndim != 2 or triangles.shape[1] != 3:
            raise InvalidValueError("triangles", "an array of shape (T, 3)", triangles.shape)
        if triangles.size and not 0 <= int(triangles.min()) <= int(triangles.max()) < vertex_count:
            got = f"{triangles.min()}..{triangles.max()}"
            raise InvalidValueError("triangles", f"vertex indices in 0..{vertex_count - 1}", got)
        self._triangles: Indices = np.ascontiguousarray(triangles, dtype=np.int32)
        self._shape = (vertex_count, 3)
        self._kernel: Callable[[Floats, Indices, Floats], None] = _reference
        if compiled:
            from agentface.mesh import normals_compiled as normals

            self._kernel = normals.vertex_normals

    def compute(self, vertices: Floats, out: Floats) -> None:
        """Writes the unit normals of ``vertices`` to ``out``, both float32 ``(V, 3)`` in C order.

        A vertex without a triangle of some area gets zero. Raises InvalidValueError for other arrays.
        """
        for name, array in (("vertices", vertices), ("out", out)):
            if array.shape != self._shape or array.dtype != np.float32 or not array.flags.c_contiguous:
                expected = f"float32 {self._shape} in C order"
                raise InvalidValueError(name, expected, f"{array.dtype} {array.shape}")
        self._kernel(vertices, self._triangles, out)


def _reference(vertices: Floats, triangles: Indices, out: Floats) -> None:
    out[:] = vertex_normals(vertices, triangles)
