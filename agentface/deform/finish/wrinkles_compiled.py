"""Wrinkle heights, compiled; the numpy twins are in :mod:`agentface.deform.finish.wrinkles`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.finish.wrinkles import WrinkleTables
from agentface.deform.simd_rows import put_row, row_at
from agentface.kernel import kernel

_ZERO, _ONE = np.float32(0.0), np.float32(1.0)


@kernel(error_model="numpy")
def levels(tables: WrinkleTables, values: Floats, out: Floats) -> None:
    """The trains' contractions ``out (K,)``."""
    for train in range(tables.parameters.shape[0]):
        level = _ZERO
        for muscle in range(tables.parameters.shape[1]):
            level = max(level, values[tables.parameters[train, muscle]])
        out[train] = min(level, _ONE)


@kernel(error_model="numpy")
def heights(tables: WrinkleTables, values: Floats, out: Floats) -> None:
    """The highest of the trains at each vertex, ``out (V,)`` m."""
    out[:] = _ZERO
    for train in range(tables.parameters.shape[0]):
        level = _ZERO
        for muscle in range(tables.parameters.shape[1]):
            level = max(level, values[tables.parameters[train, muscle]])
        if level > _ZERO:
            level = min(level, _ONE)
            for entry in range(tables.first[train], tables.first[train + 1]):
                vertex = tables.vertices[entry]
                out[vertex] = max(out[vertex], level * tables.heights[entry])


@kernel(error_model="numpy")
def raise_vertices(tables: WrinkleTables, heights: Floats, normals: Floats, vertices: Floats) -> None:
    """Moves ``vertices (V, 3)`` along ``normals (V, 3)`` by ``heights (V,)`` m."""
    for place in range(tables.raised.shape[0]):
        vertex = tables.raised[place]
        at = 3 * vertex
        put_row(vertices, at, row_at(vertices, at) + row_at(normals, at) * heights[vertex])
