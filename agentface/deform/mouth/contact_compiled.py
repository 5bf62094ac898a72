"""The loops of contact; their numpy twins are in :mod:`agentface.deform.mouth.contact`."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.morphs_compiled import jaw_slide
from agentface.deform.mouth.contact import APART, CORNER, FARTHEST, PARTINGS, ROUNDS, SPREAD, STEEP, ContactTables
from agentface.deform.simd import choose, larger, load, smaller, splat, store
from agentface.kernel import kernel

_ZERO, _QUARTER, _HALF, _ONE = np.float32(0.0), np.float32(0.25), np.float32(0.5), np.float32(1.0)
_TWO, _THREE, _FOUR, _CLOSEST = np.float32(2.0), np.float32(3.0), np.float32(4.0), np.float32(1e-6)


class Overlaps(NamedTuple):
    """Of the columns of one lip, against one ring of the other: as in the twin's ``_overlaps``, in whole vectors."""

    second: Floats
    overlap: Floats
    part: Floats
    inside: Floats


@kernel(error_model="numpy")
def apply(tables: ContactTables, values: Floats, points: Floats) -> None:
    """Shuts pressed lips, parts lips that overlap, and pushes them out of the teeth; as its twin."""
    apart = _ZERO
    for k in range(tables.morphs.shape[0]):
        apart += abs(values[tables.morphs[k]])
    apart = APART * min(_ONE, apart)
    for _ in range(ROUNDS if values[tables.press] > _ZERO else 1):
        _close_lips(tables, values[tables.press], points)
        _part_lips(tables, points, apart)
    angle = np.float32(tables.widest * values[tables.jaw])
    cosine, sine = np.float32(math.cos(angle)), np.float32(math.sin(angle))
    hinge_y, hinge_z = tables.hinge[0], tables.hinge[1]
    forth, aside = jaw_slide(tables.slides, values)
    for k in range(tables.vertex.shape[0]):
        vertex = tables.vertex[k]
        across, ahead = _push(tables, 0, k, points[vertex, 0], points[vertex, 1], points[vertex, 2])
        points[vertex, 0] += across
        points[vertex, 2] += ahead
        up, forward = points[vertex, 1] - hinge_y, points[vertex, 2] - hinge_z
        y = hinge_y + cosine * up + sine * forward
        z = hinge_z - sine * up + cosine * forward - np.float32(forth)
        across, ahead = _push(tables, 1, k, points[vertex, 0] - np.float32(aside), y, z)
        points[vertex, 0] += across
        points[vertex, 1] -= sine * ahead
        points[vertex, 2] += cosine * ahead
    for _ in range(PARTINGS):
        if not _part_lips(tables, points, apart):
            break


@kernel(error_model="numpy", inline="always")
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


@kernel(error_model="numpy")
def _close_lips(tables: ContactTables, press: np.float32, points: Floats) -> None:
    share = min(_ONE, press / np.float32(tables.shut_from))
    if share <= _ZERO:
        return
    move = np.zeros(tables.grid.shape[1], np.float32)
    for lip in range(2):
        own, other = (tables.upper, tables.lower) if lip == 0 else (tables.lower, tables.upper)
        sign = _ONE if lip == 0 else -_ONE
        gap = _gaps(tables, own, other, sign, points)
        near = np.zeros(own.shape[0], np.float32)
        for k in range(2, own.shape[0] - 2):
            near[k] = min(_ONE, max(_ZERO, _TWO - gap[k] / FARTHEST)) * gap[k]
        for k in range(1, own.shape[0] - 1):
            even = _HALF * near[k] + _QUARTER * (near[k - 1] + near[k + 1])
            move[own[k]] = -_HALF * sign * share * even
    _move(tables, move, points)


@kernel(error_model="numpy")
def _gaps(tables: ContactTables, own: Indices, other: Indices, sign: np.float32, points: Floats) -> Floats:
    """``(K,)`` m: between each of ``own`` columns and the other lip, where they are nearest; none is negative."""
    places, heights = _rings(tables, own, points)
    across, up = _rings(tables, other, points)
    found = _new_overlaps(places.shape[1])
    gap = np.full(places.shape[1], np.float32(np.inf), np.float32)
    for ring in range(across.shape[0]):
        for facing in range(across.shape[0]):
            _overlap(across[facing], up[facing], other.shape[0], places[ring], heights[ring], sign, found)
            for k in range(gap.shape[0]):
                gap[k] = max(min(gap[k], -found.overlap[k]), _ZERO)
    return gap


@kernel(error_model="numpy")
def _part_lips(tables: ContactTables, points: Floats, apart: np.float32) -> bool:
    """Whether any lip had to give way: where none had, another round would find none."""
    columns = tables.grid.shape[1]
    up, down = np.zeros(columns, np.float32), np.zeros(columns, np.float32)
    any_up = _push_apart(tables, tables.upper, tables.lower, tables.overlap_upper, apart, _ONE, points, up, down)
    any_down = _push_apart(tables, tables.lower, tables.upper, tables.overlap_lower, apart, -_ONE, points, down, up)
    if not (any_up or any_down):
        return False
    move = up - down
    for end in (0, -1):
        a, b = tables.upper[end], tables.lower[end]
        move[a] = _HALF * (move[a] + move[b])
        move[b] = move[a]
    _move(tables, move, points)
    return True


@kernel(error_model="numpy")
def _move(tables: ContactTables, move: Floats, points: Floats) -> None:
    for ring in range(tables.grid.shape[0]):
        for column in range(tables.grid.shape[1]):
            points[tables.grid[ring, column], 1] += tables.fall[ring] * move[column]


@kernel(error_model="numpy")
def _push_apart(
    tables: ContactTables,
    own: Indices,
    other: Indices,
    at_rest: Floats,
    apart: np.float32,
    sign: np.float32,
    points: Floats,
    own_push: Floats,
    other_push: Floats,
) -> bool:
    touched = False
    places, heights = _rings(tables, own, points)
    across, up = _rings(tables, other, points)
    found = _new_overlaps(places.shape[1])
    for ring in range(across.shape[0]):
        for facing in range(across.shape[0]):
            _overlap(across[facing], up[facing], other.shape[0], places[ring], heights[ring], sign, found)
            for k in range(1, own.shape[0] - 1):
                push = _HALF * (found.overlap[k] - at_rest[k] + apart)
                inside = found.inside[k]
                if push <= _ZERO or inside <= _ZERO:
                    continue
                touched = True
                near, part, second = min(_ONE, inside / CORNER), found.part[k], np.int32(found.second[k])
                push *= near * near
                a, b = other[second - 1], other[second]
                own_push[own[k]] = max(own_push[own[k]], push)
                other_push[a] = max(other_push[a], push * SPREAD * min(_ONE, STEEP * (_ONE - part)))
                other_push[b] = max(other_push[b], push * SPREAD * min(_ONE, STEEP * part))
    return touched


@kernel(error_model="numpy")
def _rings(tables: ContactTables, columns: Indices, points: Floats) -> Any:
    """``(rings, K)`` m twice: x and y of the rings that may touch, in these columns and again the last, in blocks."""
    count = (columns.shape[0] + LANES - 1) // LANES * LANES
    across = np.empty((tables.last + 1 - tables.first, count), np.float32)
    up = np.empty_like(across)
    for ring in range(across.shape[0]):
        for j in range(count):
            vertex = tables.grid[tables.first + ring, columns[min(j, columns.shape[0] - 1)]]
            across[ring, j], up[ring, j] = points[vertex, 0], points[vertex, 1]
    return across, up


@kernel(error_model="numpy")
def _new_overlaps(count: int) -> Overlaps:
    return Overlaps(
        np.empty(count, np.float32),
        np.empty(count, np.float32),
        np.empty(count, np.float32),
        np.empty(count, np.float32),
    )


@kernel(error_model="numpy")
def _overlap(
    across: Floats, up: Floats, count: int, places: Floats, heights: Floats, sign: np.float32, found: Overlaps
) -> None:
    """How far ``places`` with their ``heights`` lie beyond one ring of the other lip, of ``count`` columns."""
    one, zero = splat(_ONE), splat(_ZERO)
    for block in range(0, places.shape[0], LANES):
        x = load(places, block)
        second, here, there, low, high = one, splat(across[0]), splat(across[1]), splat(up[0]), splat(up[1])
        for j in range(1, count - 1):
            before = splat(across[j]) - x
            second = choose(before, splat(np.float32(j + 1)), second)
            here, there = choose(before, splat(across[j]), here), choose(before, splat(across[j + 1]), there)
            low, high = choose(before, splat(up[j]), low), choose(before, splat(up[j + 1]), high)
        part = smaller(one, larger(zero, (here - x) / larger(here - there, splat(_CLOSEST))))
        beyond = larger(x - splat(across[0]), splat(across[count - 1]) - x)
        overlap = (low + part * (high - low) - load(heights, block)) * sign - larger(beyond, zero)
        store(found.second, block, second)
        store(found.part, block, part)
        store(found.inside, block, zero - beyond)
        store(found.overlap, block, overlap)
