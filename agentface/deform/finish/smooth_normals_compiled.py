"""Normals of the skin, single precision; the numpy twin is :mod:`.smooth_normals`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.finish.smooth_normals import SmoothNormalTables
from agentface.deform.lanes import LANES
from agentface.deform.simd import inverse_root, where_positive
from agentface.deform.simd_rows import (
    cross,
    dot,
    put_narrow_columns,
    put_row,
    put_wide_row,
    row_at,
    wide_row_at,
    xs_of,
    ys_of,
    zs_of,
)
from agentface.kernel import kernel

_ZERO, _ONE = np.float32(0.0), np.float32(1.0)
_SMALLEST = np.float32(1e-36)  # m^4, near the end of single precision


@kernel(fastmath=True, error_model="numpy")
def apply(tables: SmoothNormalTables, vertices: Floats, out: Floats) -> None:
    """Write the area-weighted unit normals of ``vertices (V, 3)`` m into ``out (V, 3)``; without any area, zero."""
    sums = np.zeros((vertices.shape[0], 4), np.float32)
    add_areas(vertices, tables.quads, sums)
    whole = vertices.shape[0] // LANES * LANES
    for start in range(0, whole, LANES):
        x, y, z = xs_of(sums, 4 * start), ys_of(sums, 4 * start), zs_of(sums, 4 * start)
        square = x * x + y * y + z * z
        scale = where_positive(square - _SMALLEST, inverse_root(square))
        put_narrow_columns(out, 3 * start, x * scale, y * scale, z * scale)
    for vertex in range(whole, vertices.shape[0]):
        put_unit(sums, vertex, out)


@kernel(fastmath=True, error_model="numpy")
def add_areas(vertices: Floats, quads: Indices, sums: Floats) -> None:
    """Add to each corner's row of ``sums (V, 4)`` its triangles' normals, as long as twice their areas, m^2."""
    for quad in range(quads.shape[0]):
        a, b, c, d = quads[quad, 0], quads[quad, 1], quads[quad, 2], quads[quad, 3]
        start = row_at(vertices, 3 * a)
        across = row_at(vertices, 3 * c) - start
        one, other = cross(row_at(vertices, 3 * b) - start, across), cross(across, row_at(vertices, 3 * d) - start)
        both = one + other
        _add(sums, a, both)
        _add(sums, b, one)
        _add(sums, c, both)
        _add(sums, d, other)


@kernel(fastmath=True, error_model="numpy")
def _add(sums: Floats, vertex: int, area: Any) -> None:
    put_wide_row(sums, 4 * vertex, wide_row_at(sums, 4 * vertex) + area)


@kernel(fastmath=True, error_model="numpy")
def put_unit(sums: Floats, vertex: int, out: Floats) -> None:
    """Write a row of ``sums (V, 4)`` to ``out (V, 3)``, scaled to length 1; one too short for that as zero."""
    total = wide_row_at(sums, 4 * vertex)
    square = dot(total, total)
    scale = _ONE / np.float32(math.sqrt(square)) if square > _SMALLEST else _ZERO
    put_row(out, 3 * vertex, total * scale)
