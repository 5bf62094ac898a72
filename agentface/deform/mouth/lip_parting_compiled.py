"""The loops of lips against lips; their numpy twins are in :mod:`agentface.deform.mouth.lip_parting`."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.mouth.contact_tables import ContactTables
from agentface.deform.mouth.lip_parting import CORNER, FARTHEST, SEALED_ABOVE, SEALINGS, SPREAD, STEEP
from agentface.deform.simd import choose, larger, load, smaller, splat, store
from agentface.kernel import kernel

_ZERO, _QUARTER, _HALF, _ONE = np.float32(0.0), np.float32(0.25), np.float32(0.5), np.float32(1.0)
_TWO, _CLOSEST = np.float32(2.0), np.float32(1e-6)


class Overlaps(NamedTuple):
    """Of the columns of one lip, against one ring of the other: as in the twin's ``overlaps``, in whole vectors."""

    second: Floats
    overlap: Floats
    portion: Floats
    inside: Floats


@kernel(error_model="numpy")
def close(tables: ContactTables, press: np.float32, points: Floats) -> None:
    """Press draws lips together that are a little apart; as its twin."""
    share = min(_ONE, press / np.float32(tables.shut_from))
    if share <= _ZERO:
        return
    move = np.zeros(tables.grid.shape[1], np.float32)
    for lip in range(2):
        own, other = (tables.upper, tables.lower) if lip == 0 else (tables.lower, tables.upper)
        sign = _ONE if lip == 0 else -_ONE
        gap = gaps(tables, own, other, sign, points)
        near = np.zeros(own.shape[0], np.float32)
        for k in range(2, own.shape[0] - 2):
            near[k] = min(_ONE, max(_ZERO, _TWO - gap[k] / FARTHEST)) * gap[k]
        for k in range(1, own.shape[0] - 1):
            even = _HALF * near[k] + _QUARTER * (near[k - 1] + near[k + 1])
            move[own[k]] = -_HALF * sign * share * even
    _move(tables, move, points)


@kernel(error_model="numpy")
def gaps(tables: ContactTables, own: Indices, other: Indices, sign: np.float32, points: Floats) -> Floats:
    """``(K,)`` m: between each of ``own`` columns and the other lip, where they are nearest; none is negative."""
    places, heights = _rings(tables, own, points)
    across, up = _rings(tables, other, points)
    _put_in_order(across)
    found = _new_overlaps(places.shape[1])
    gap = np.full(places.shape[1], np.float32(np.inf), np.float32)
    for ring in range(across.shape[0]):
        for facing in range(across.shape[0]):
            _overlap(across[facing], up[facing], other.shape[0], places[ring], heights[ring], sign, found)
            for k in range(gap.shape[0]):
                gap[k] = max(min(gap[k], -found.overlap[k]), _ZERO)
    return gap


@kernel(error_model="numpy")
def part(tables: ContactTables, points: Floats, apart: np.float32) -> bool:
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
def seal(tables: ContactTables, level: np.float32, apart: np.float32, points: Floats) -> None:
    """Draws the lips together, whatever has parted them; as its twin."""
    share = _ONE - max(_ZERO, _ONE - level) ** np.float32(0.5 / SEALINGS)
    move = np.zeros(tables.grid.shape[1], np.float32)
    for _ in range(SEALINGS):
        for lip in range(2):
            own, other = (tables.upper, tables.lower) if lip == 0 else (tables.lower, tables.upper)
            sign = _ONE if lip == 0 else -_ONE
            of_way = SEALED_ABOVE if lip == 0 else _ONE - SEALED_ABOVE
            gap = gaps(tables, own, other, sign, points)
            gap[0], gap[own.shape[0] - 1] = _ZERO, _ZERO
            for k in range(1, own.shape[0] - 1):
                even = _HALF * gap[k] + _QUARTER * (gap[k - 1] + gap[k + 1])
                move[own[k]] = -sign * of_way * share * max(even, gap[k])
        _move(tables, move, points)
        part(tables, points, apart)


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
    _put_in_order(across)
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
                near, portion, second = min(_ONE, inside / CORNER), found.portion[k], np.int32(found.second[k])
                push *= near * near
                a, b = other[second - 1], other[second]
                own_push[own[k]] = max(own_push[own[k]], push)
                other_push[a] = max(other_push[a], push * SPREAD * min(_ONE, STEEP * (_ONE - portion)))
                other_push[b] = max(other_push[b], push * SPREAD * min(_ONE, STEEP * portion))
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
def _put_in_order(across: Floats) -> None:
    """From left to right, also where a ring folds back; as the twin's ``_in_order``."""
    back = np.empty(across.shape[1], np.float32)
    for ring in range(across.shape[0]):
        row = across[ring]
        back[-1] = row[-1]
        for j in range(row.shape[0] - 2, -1, -1):
            back[j] = max(row[j], back[j + 1])
        forth = row[0]
        for j in range(row.shape[0]):
            forth = min(forth, row[j])
            row[j] = _HALF * (forth + back[j])


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
        portion = smaller(one, larger(zero, (here - x) / larger(here - there, splat(_CLOSEST))))
        beyond = larger(x - splat(across[0]), splat(across[count - 1]) - x)
        overlap = (low + portion * (high - low) - load(heights, block)) * sign - larger(beyond, zero)
        store(found.second, block, second)
        store(found.portion, block, portion)
        store(found.inside, block, zero - beyond)
        store(found.overlap, block, overlap)
