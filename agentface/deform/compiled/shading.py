"""Normals once wrinkles have risen, single precision; the numpy twin is :mod:`agentface.deform.shading`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

from agentface.conventions import Floats
from agentface.deform.shading import ShadingTables

_ZERO, _ONE = np.float32(0.0), np.float32(1.0)
_SMALLEST = np.float32(1e-36)  # m^4, near the end of single precision


@njit(cache=True, nogil=True, error_model="numpy", fastmath=True)
def apply(tables: ShadingTables, heights: Floats, vertices: Floats, smooth: Floats, out: Floats) -> None:
    """Write to ``out (V, 3)`` the unit normals of ``vertices (V, 3)``, raised by ``heights (V,)``."""
    before, after = smooth.ravel(), out.ravel()
    for index in range(before.shape[0]):
        after[index] = before[index]
    if _highest(tables, heights) > _ZERO:
        _renew(tables, vertices, smooth, out)


@njit(cache=True, nogil=True, error_model="numpy", fastmath=True)
def _renew(tables: ShadingTables, vertices: Floats, smooth: Floats, out: Floats) -> None:
    for place in range(tables.near.shape[0]):
        for axis in range(3):
            out[tables.near[place], axis] = _ZERO
    for triangle in range(tables.around.shape[0]):
        a, b, c = tables.around[triangle, 0], tables.around[triangle, 1], tables.around[triangle, 2]
        x, y, z = vertices[a, 0], vertices[a, 1], vertices[a, 2]
        ux, uy, uz = vertices[b, 0] - x, vertices[b, 1] - y, vertices[b, 2] - z
        vx, vy, vz = vertices[c, 0] - x, vertices[c, 1] - y, vertices[c, 2] - z
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for corner in (a, b, c):
            out[corner, 0] += nx
            out[corner, 1] += ny
            out[corner, 2] += nz
    for place in range(tables.near.shape[0]):
        vertex = tables.near[place]
        square = out[vertex, 0] ** 2 + out[vertex, 1] ** 2 + out[vertex, 2] ** 2
        scale = _ONE / math.sqrt(square) if square > _SMALLEST else _ZERO
        for axis in range(3):
            out[vertex, axis] *= scale
    for place in range(tables.border.shape[0]):
        vertex = tables.border[place]
        for axis in range(3):
            out[vertex, axis] = smooth[vertex, axis]


@njit(cache=True, nogil=True, error_model="numpy")
def _highest(tables: ShadingTables, heights: Floats) -> Any:
    highest = _ZERO
    for place in range(tables.raised.shape[0]):
        highest = max(highest, heights[tables.raised[place]])
    return highest
