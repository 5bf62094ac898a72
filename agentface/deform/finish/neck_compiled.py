"""The neck, single precision; the numpy twin is :mod:`.neck`."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Floats
from agentface.deform.finish.neck import NeckTables
from agentface.kernel import kernel

_ONE = np.float32(1.0)
_SHORTEST = np.float32(1e-36)  # squared


@kernel(error_model="numpy")
def apply(tables: NeckTables, head: Floats, vertices: Floats, normals: Floats, smooth: Floats) -> None:
    """Hold the neck back in place, where ``head (4, 4)`` turns all of the rest: ``vertices (V, 3)`` m, unit normals."""
    if _ahead(head):
        return
    for entry in range(tables.where.shape[0]):
        vertex, stays = tables.where[entry], tables.stays[entry]
        x = vertices[vertex, 0] - head[0, 3]
        y = vertices[vertex, 1] - head[1, 3]
        z = vertices[vertex, 2] - head[2, 3]
        for axis in range(3):
            home = x * head[0, axis] + y * head[1, axis] + z * head[2, axis]
            vertices[vertex, axis] += stays * (home - vertices[vertex, axis])
        _turn_back(normals, vertex, stays, head)
        _turn_back(smooth, vertex, stays, head)


@kernel(error_model="numpy")
def _ahead(head: Floats) -> bool:
    """Whether the head is not turned at all."""
    return bool(head[0, 0] == _ONE and head[1, 1] == _ONE and head[2, 2] == _ONE)


@kernel(error_model="numpy")
def _turn_back(normals: Floats, vertex: int, stays: np.float32, head: Floats) -> None:
    x, y, z = normals[vertex, 0], normals[vertex, 1], normals[vertex, 2]
    square = np.float32(0.0)
    for axis in range(3):
        home = x * head[0, axis] + y * head[1, axis] + z * head[2, axis]
        normals[vertex, axis] += stays * (home - normals[vertex, axis])
        square += normals[vertex, axis] * normals[vertex, axis]
    scale = _ONE / np.float32(math.sqrt(max(square, _SHORTEST)))
    for axis in range(3):
        normals[vertex, axis] *= scale
