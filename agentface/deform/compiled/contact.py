"""The loops of contact; their numpy twins are in :mod:`agentface.deform.contact`."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numba import njit

from agentface.conventions import Floats, Indices
from agentface.deform.contact import SPREAD, STEEP, ContactTables

_ZERO, _HALF, _ONE = np.float32(0.0), np.float32(0.5), np.float32(1.0)
_TWO, _THREE, _FOUR, _CLOSEST = np.float32(2.0), np.float32(3.0), np.float32(4.0), np.float32(1e-6)


@njit(cache=True, nogil=True, error_model="numpy")
def apply(tables: ContactTables, values: Floats, points: Floats) -> None:
    """Parts the lips and pushes them out of the teeth; as its twin."""
    _part_lips(tables, points)
    angle = np.float32(tables.widest * values[tables.jaw])
    cosine, sine = np.float32(math.cos(angle)), np.float32(math.sin(angle))
    hinge_y, hinge_z = tables.hinge[0], tables.hinge[1]
    for k in range(tables.vertex.shape[0]):
        vertex = tables.vertex[k]
        across, ahead = _push(tables, 0, k, points[vertex, 0], points[vertex, 1], points[vertex, 2])
        points[vertex, 0] += across
        points[vertex, 2] += ahead
        up, forward = points[vertex, 1] - hinge_y, points[vertex, 2] - hinge_z
        y = hinge_y + cosine * up + sine * forward
        z = hinge_z - sine * up + cosine * forward
        across, ahead = _push(tables, 1, k, points[vertex, 0], y, z)
        points[vertex, 0] += across
        points[vertex, 1] -= sine * ahead
        points[vertex, 2] += cosine * ahead


@njit(cache=True, nogil=True, error_model="numpy", inline="always")
def _push(tables: ContactTables, arch: int, k: int, x: float, y: float, z: float) -> Any:
    kept = tables.kept[arch, k]
    if kept < _ZERO:
        return _ZERO, _ZERO
    beyond = (tables.arch[arch, 2] - y) / tables.arch[arch, 3]
    if beyond >= _ONE:
        return _ZERO, _ZERO
    share = min(_ONE, _ONE - beyond)
    share = share * share * (_THREE - _TWO * share)
    slope = _TWO * tables.arch[arch, 1] * x
    steepness = np.float32(math.sqrt(_ONE + slope * slope))
    distance = (z - tables.arch[arch, 0] + tables.arch[arch, 1] * x * x) / steepness
    soft = tables.softness[arch, k]
    over = soft - (distance - kept)
    if over <= _ZERO:
        return _ZERO, _ZERO
    push = share * (over * over / (_FOUR * soft) if over < _TWO * soft else over - soft) / steepness
    return push * slope, push


@njit(cache=True, nogil=True, error_model="numpy")
def _part_lips(tables: ContactTables, points: Floats) -> None:
    columns = tables.grid.shape[1]
    up, down = np.zeros(columns, np.float32), np.zeros(columns, np.float32)
    any_up = _push_apart(tables, tables.upper, tables.lower, tables.overlap_upper, _ONE, points, up, down)
    any_down = _push_apart(tables, tables.lower, tables.upper, tables.overlap_lower, -_ONE, points, down, up)
    if not (any_up or any_down):
        return
    for ring in range(tables.grid.shape[0]):
        for column in range(columns):
            points[tables.grid[ring, column], 1] += tables.fall[ring] * (up[column] - down[column])


@njit(cache=True, nogil=True, error_model="numpy")
def _push_apart(
    tables: ContactTables,
    own: Indices,
    other: Indices,
    at_rest: Floats,
    sign: np.float32,
    points: Floats,
    own_push: Floats,
    other_push: Floats,
) -> bool:
    seam = tables.grid[tables.seam]
    touched = False
    outermost = np.empty(other.shape[0], np.float32)
    for j in range(other.shape[0]):
        outermost[j] = -np.float32(np.inf)
        for ring in range(tables.first, tables.last + 1):
            outermost[j] = max(outermost[j], sign * points[tables.grid[ring, other[j]], 1])
    for ring in range(tables.first, tables.last + 1):
        for k in range(1, own.shape[0] - 1):
            vertex = tables.grid[ring, own[k]]
            at = points[vertex, 0]
            second = 1
            for j in range(1, other.shape[0] - 1):
                if points[seam[other[j]], 0] >= at:
                    second += 1
            first, last = points[seam[other[second - 1]], 0], points[seam[other[second]], 0]
            part = min(_ONE, max(_ZERO, (first - at) / max(first - last, _CLOSEST)))
            there = outermost[second - 1] + part * (outermost[second] - outermost[second - 1])
            push = _HALF * (there - sign * points[vertex, 1] - at_rest[k])
            if push <= _ZERO:
                continue
            touched = True
            a, b = other[second - 1], other[second]
            own_push[own[k]] = max(own_push[own[k]], push)
            other_push[a] = max(other_push[a], push * SPREAD * min(_ONE, STEEP * (_ONE - part)))
            other_push[b] = max(other_push[b], push * SPREAD * min(_ONE, STEEP * part))
    return touched
