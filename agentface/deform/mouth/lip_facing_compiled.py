"""Where each vertex of one lip faces the other: found once while their x stay, which lips pushed up and down keep.

The numpy twin is :func:`agentface.deform.mouth.lip_parting.overlaps`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.mouth.contact_tables import ContactTables
from agentface.deform.mouth.lip_parting import CORNER
from agentface.deform.simd import choose, gather, larger, load, smaller, splat, store, store_whole
from agentface.kernel import kernel

_ZERO, _HALF, _ONE = np.float32(0.0), np.float32(0.5), np.float32(1.0)
_CLOSEST = np.float32(1e-6)
_PER_CORNER = np.float32(1.0 / CORNER)
_UNKNOWN = np.float32(-1e3)  # m, where no vertex is


class Facing(NamedTuple):
    """One lip before the other: its K columns on r rings in one row of N = r K, up to whole blocks, and r rings there.

    Attributes:
        columns: K; ``others``: those of the other lip.
        start: where its columns begin in :attr:`LipColumns.heights`; ``others_start``: where the other's do.
        sign: 1 for the upper lip, else -1.
        column: int32 ``(N,)``, the column of each vertex; ``inner (N,)``, 1 and in the corners and behind the end 0.
        at_rest: ``(N,)`` m, how far it overlaps there at rest.
        place: int32 ``(r, N)``, the first of the two columns that each vertex lies between; ``portion (r, N)`` 0..1,
            how far towards the second; ``beyond (r, N)`` m, how far outside the ring's ends.
        near: ``(r, N)`` 0..1, how much of a push counts so near to these; 0 in the corners.
        x: ``(N,)`` m, of its vertices, ``rings (r, K)`` m of the other lip, from left to right, when it was found.
        own: ``(N,)`` m, its heights, ``best (N,)`` and ``push (r, N)`` m, overwritten.
    """

    columns: int
    others: int
    start: int
    others_start: int
    sign: np.float32
    column: Indices
    inner: Floats
    at_rest: Floats
    place: Indices
    portion: Floats
    beyond: Floats
    near: Floats
    x: Floats
    rings: Floats
    own: Floats
    best: Floats
    push: Floats


class LipColumns(NamedTuple):
    """Both lips: the C columns of the upper one, then those of the lower one, up to whole blocks.

    ``heights (R, C)`` m are those of all rings, ``across (r, C)`` m the x of those that may touch.
    """

    heights: Floats
    across: Floats
    upper: Facing
    lower: Facing


@kernel(error_model="numpy")
def look(tables: ContactTables, points: Floats) -> LipColumns:
    """The lips of ``points (P, 3)`` m."""
    upper, lower = tables.upper.shape[0], tables.lower.shape[0]
    rings, count = tables.last + 1 - tables.first, _blocks(upper + lower)
    heights = np.zeros((tables.grid.shape[0], count), np.float32)
    across = np.zeros((rings, count), np.float32)
    mouth = LipColumns(
        heights,
        across,
        _new_facing(rings, upper, lower, 0, upper, _ONE, tables.overlap_upper),
        _new_facing(rings, lower, upper, upper, 0, -_ONE, tables.overlap_lower),
    )
    look_again(tables, points, mouth)
    return mouth


@kernel(error_model="numpy")
def look_again(tables: ContactTables, points: Floats, mouth: LipColumns) -> None:
    """Takes the lips of other ``points (P, 3)`` m into ``mouth``."""
    for ring in range(mouth.heights.shape[0]):
        for k in range(tables.lips.shape[1]):
            mouth.heights[ring, k] = points[tables.lips[ring, k], 1]
    for ring in range(mouth.across.shape[0]):
        for k in range(tables.lips.shape[1]):
            mouth.across[ring, k] = points[tables.lips[tables.first + ring, k], 0]
    find(mouth.across, mouth.upper)
    find(mouth.across, mouth.lower)


@kernel(error_model="numpy")
def put(tables: ContactTables, mouth: LipColumns, points: Floats) -> None:
    """Writes the heights to ``points (P, 3)`` m."""
    for ring in range(mouth.heights.shape[0]):
        for k in range(tables.lips.shape[1]):
            points[tables.lips[ring, k], 1] = mouth.heights[ring, k]


@kernel(error_model="numpy")
def _blocks(count: int) -> int:
    return (count + LANES - 1) // LANES * LANES


@kernel(error_model="numpy")
def _new_facing(
    rings: int, columns: int, others: int, start: int, others_start: int, sign: np.float32, overlap: Floats
) -> Facing:
    count = _blocks(rings * columns)
    column, inner, at_rest = np.zeros(count, np.int32), np.zeros(count, np.float32), np.zeros(count, np.float32)
    for ring in range(rings):
        for k in range(columns):
            vertex = ring * columns + k
            column[vertex], at_rest[vertex] = k, overlap[k]
            inner[vertex] = _ONE if 0 < k < columns - 1 else _ZERO
    return Facing(
        columns,
        others,
        start,
        others_start,
        sign,
        column,
        inner,
        at_rest,
        np.empty((rings, count), np.int32),
        np.empty((rings, count), np.float32),
        np.empty((rings, count), np.float32),
        np.empty((rings, count), np.float32),
        np.full(count, _UNKNOWN, np.float32),
        np.full((rings, others), _UNKNOWN, np.float32),
        np.zeros(count, np.float32),
        np.empty(count, np.float32),
        np.empty((rings, count), np.float32),
    )


@kernel(error_model="numpy")
def find(across: Floats, facing: Facing) -> None:
    """Writes where a lip faces the other, whose vertices and its own have the x ``across (r, C)`` m.

    What has not moved since faces what it faced.
    """
    rings, blocks = facing.place.shape[0], facing.x.shape[0] // LANES
    moved, row = np.zeros(blocks, np.bool_), np.empty(facing.others, np.float32)
    back = np.empty_like(row)
    for ring in range(rings):
        for k in range(facing.columns):
            vertex, x = ring * facing.columns + k, across[ring, facing.start + k]
            if facing.x[vertex] != x:
                facing.x[vertex], moved[vertex // LANES] = x, True
    for ring in range(rings):
        _put_in_order(across[ring, facing.others_start : facing.others_start + facing.others], row, back)
        other_moved = False
        for k in range(facing.others):
            if facing.rings[ring, k] != row[k]:
                facing.rings[ring, k], other_moved = row[k], True
        for block in range(blocks):
            if other_moved or moved[block]:
                _find(row, ring, LANES * block, facing)


@kernel(error_model="numpy")
def _put_in_order(across: Floats, row: Floats, back: Floats) -> None:
    """Writes to ``row`` a ring from left to right, also where it folds back; as the twin's ``_in_order``."""
    last = across.shape[0] - 1
    back[last] = across[last]
    for j in range(last - 1, -1, -1):
        back[j] = max(across[j], back[j + 1])
    forth = across[0]
    for j in range(across.shape[0]):
        forth = min(forth, across[j])
        row[j] = _HALF * (forth + back[j])


@kernel(error_model="numpy", inline="always")
def _find(row: Floats, ring: int, block: int, facing: Facing) -> None:
    """Where one block of vertices faces one ring of the other lip, of the x ``row``, which never rise."""
    zero, one, last = splat(_ZERO), splat(_ONE), row.shape[0] - 1
    x, place, at = load(facing.x, block), zero, ring * facing.x.shape[0] + block
    for j in range(1, last):
        place = place + choose(row[j] - x, one, zero)
    store_whole(facing.place, at, place)
    here, there = gather(row, facing.place, at, 0), gather(row, facing.place, at, 1)
    store(facing.portion, at, smaller(one, larger(zero, (here - x) / larger(here - there, splat(_CLOSEST)))))
    beyond = larger(x - row[0], row[last] - x)
    store(facing.beyond, at, larger(beyond, zero))
    near = smaller(one, larger(zero - beyond, zero) * _PER_CORNER)
    store(facing.near, at, near * near * load(facing.inner, block))


@kernel(error_model="numpy")
def take_heights(first: int, heights: Floats, facing: Facing) -> None:
    """Writes the lip's own heights on the rings from ``first`` on where :func:`overlap` finds them."""
    for ring in range(facing.place.shape[0]):
        for k in range(facing.columns):
            facing.own[ring * facing.columns + k] = heights[first + ring, facing.start + k]


@kernel(error_model="numpy", inline="always")
def overlap(first: int, heights: Floats, facing: Facing, ring: int, block: int) -> Any:
    """How far a block of vertices lies beyond a ring of the other lip, of those from ``first`` on, m."""
    at, base = ring * facing.own.shape[0] + block, (first + ring) * heights.shape[1] + facing.others_start
    low, high = gather(heights, facing.place, at, base), gather(heights, facing.place, at, base + 1)
    there = low + load(facing.portion, at) * (high - low)
    return (there - load(facing.own, block)) * facing.sign - load(facing.beyond, at)
