"""The loops of lips against lips; their numpy twins are in :mod:`agentface.deform.mouth.lip_parting`."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.mouth.contact_tables import ContactTables
from agentface.deform.mouth.lip_facing_compiled import Facing, LipColumns, look, overlap, take_heights
from agentface.deform.mouth.lip_parting import FARTHEST, SEALED_ABOVE, SEALINGS, SPREAD, STEEP
from agentface.deform.simd import larger, largest, load, splat, store
from agentface.kernel import kernel

_ZERO, _QUARTER, _HALF, _ONE, _TWO = (np.float32(number) for number in (0.0, 0.25, 0.5, 1.0, 2.0))


@kernel(error_model="numpy")
def close(tables: ContactTables, press: np.float32, mouth: LipColumns) -> None:
    """Press draws lips together that are a little apart; as its twin."""
    share = min(_ONE, press / np.float32(tables.shut_from))
    if share <= _ZERO:
        return
    move = np.zeros(mouth.heights.shape[1], np.float32)
    for facing in (mouth.upper, mouth.lower):
        gap = _gaps(tables.first, mouth.heights, facing)
        near, last = np.zeros(facing.columns, np.float32), facing.columns - 1
        for k in range(2, last - 1):
            near[k] = min(_ONE, max(_ZERO, _TWO - gap[k] / FARTHEST)) * gap[k]
        for k in range(1, last):
            even = _HALF * near[k] + _QUARTER * (near[k - 1] + near[k + 1])
            move[facing.start + k] = -_HALF * facing.sign * share * even
    _move(tables.fall, move, mouth.heights)


@kernel(error_model="numpy")
def gaps(tables: ContactTables, own: Indices, other: Indices, sign: np.float32, points: Floats) -> Floats:
    """``(K,)`` m: between each of ``own`` columns and the other lip, where they are nearest; as its twin."""
    mouth = look(tables, points)
    if sign > _ZERO:
        return _gaps(tables.first, mouth.heights, mouth.upper)
    return _gaps(tables.first, mouth.heights, mouth.lower)


@kernel(error_model="numpy")
def _gaps(first: int, heights: Floats, facing: Facing) -> Any:
    """``(K,)`` m, how far each column is from the other lip where they are nearest; none is negative."""
    rings, columns = facing.place.shape[0], facing.columns
    take_heights(first, heights, facing)
    for block in range(0, facing.own.shape[0], LANES):
        most = overlap(first, heights, facing, 0, block)
        for ring in range(1, rings):
            most = larger(overlap(first, heights, facing, ring, block), most)
        store(facing.best, block, most)
    gap = np.empty(columns, np.float32)
    for k in range(columns):
        most = facing.best[k]
        for ring in range(1, rings):
            most = max(most, facing.best[ring * columns + k])
        gap[k] = max(-most, _ZERO)
    return gap


@kernel(error_model="numpy")
def part(tables: ContactTables, apart: np.float32, mouth: LipColumns) -> bool:
    """Whether any lip had to give way: where none had, another round would find none."""
    up, down = np.zeros(mouth.heights.shape[1], np.float32), np.zeros(mouth.heights.shape[1], np.float32)
    any_up = _push_apart(tables.first, mouth.heights, mouth.upper, apart, up, down)
    any_down = _push_apart(tables.first, mouth.heights, mouth.lower, apart, down, up)
    if not (any_up or any_down):
        return False
    move = up - down
    upper, lower = mouth.upper, mouth.lower
    for a, b in ((0, upper.columns), (upper.columns - 1, upper.columns + lower.columns - 1)):
        move[a] = _HALF * (move[a] + move[b])
        move[b] = move[a]
    _move(tables.fall, move, mouth.heights)
    return True


@kernel(error_model="numpy")
def seal(tables: ContactTables, level: np.float32, apart: np.float32, mouth: LipColumns) -> None:
    """Draws the lips together, whatever has parted them; as its twin."""
    share = _ONE - max(_ZERO, _ONE - level) ** np.float32(0.5 / SEALINGS)
    move = np.zeros(mouth.heights.shape[1], np.float32)
    for _ in range(SEALINGS):
        for facing, of_way in ((mouth.upper, SEALED_ABOVE), (mouth.lower, _ONE - SEALED_ABOVE)):
            gap, last = _gaps(tables.first, mouth.heights, facing), facing.columns - 1
            gap[0], gap[last] = _ZERO, _ZERO
            for k in range(1, last):
                even = _HALF * gap[k] + _QUARTER * (gap[k - 1] + gap[k + 1])
                move[facing.start + k] = -facing.sign * of_way * share * max(even, gap[k])
        _move(tables.fall, move, mouth.heights)
        part(tables, apart, mouth)


@kernel(error_model="numpy")
def _move(fall: Floats, move: Floats, heights: Floats) -> None:
    for ring in range(heights.shape[0]):
        for block in range(0, heights.shape[1], LANES):
            at = ring * heights.shape[1] + block
            store(heights, at, load(heights, at) + load(move, block) * fall[ring])


@kernel(error_model="numpy")
def _push_apart(
    first: int, heights: Floats, facing: Facing, apart: np.float32, own_push: Floats, other_push: Floats
) -> bool:
    touched, rings = False, facing.place.shape[0]
    take_heights(first, heights, facing)
    for block in range(0, facing.own.shape[0], LANES):
        most = splat(_ZERO)
        for ring in range(rings):
            over = overlap(first, heights, facing, ring, block) - load(facing.at_rest, block) + apart
            vector = over * _HALF * load(facing.near, ring * facing.own.shape[0] + block)
            store(facing.push, ring * facing.own.shape[0] + block, vector)
            most = larger(vector, most)
        store(facing.best, block, most)
        if largest(most) > _ZERO:
            touched = True
            for vertex in range(block, block + LANES):
                own = facing.start + facing.column[vertex]
                own_push[own] = max(own_push[own], facing.best[vertex])
            for ring in range(rings):
                for vertex in range(block, block + LANES):
                    push = facing.push[ring, vertex]
                    if push > _ZERO:
                        other, portion = facing.others_start + facing.place[ring, vertex], facing.portion[ring, vertex]
                        there, next_there = min(_ONE, STEEP * (_ONE - portion)), min(_ONE, STEEP * portion)
                        other_push[other] = max(other_push[other], push * SPREAD * there)
                        other_push[other + 1] = max(other_push[other + 1], push * SPREAD * next_there)
    return touched
