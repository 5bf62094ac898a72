"""Lips against lips: parted where they overlap, drawn together where something closes them."""

from __future__ import annotations

from typing import TypeVar

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.mouth.contact_tables import ContactTables

_Points = TypeVar("_Points", Floats, Doubles)
SPREAD, STEEP = np.float32(1.07), np.float32(4.0)
"""How the push at a place between two columns is shared: enough for their mean, and continuous."""
FARTHEST = np.float32(0.001)
"""m, the gap that press still closes; one twice as wide it leaves."""
CORNER = np.float32(0.0015)
"""m from a ring's ends over which the push sets in: there its columns may run back and forth."""
SEALINGS = 3
"""How often sealed lips are drawn together before the teeth push them, and how often after."""
SEALED_ABOVE = np.float32(0.4)
"""The upper lip's share of the way: the lower one is the more mobile."""


def close(tables: ContactTables, press: float, points: Floats) -> None:
    """Press draws lips together that are a little apart: columns go half of the way, evened out."""
    share = min(np.float32(1.0), np.float32(press) / tables.shut_from)
    if share <= 0.0:
        return
    move = np.zeros(tables.grid.shape[1], np.float32)
    for own, other, sign in _lips(tables):
        gap = gaps(tables, own, other, sign, points)
        near = np.clip(np.float32(2.0) - gap / FARTHEST, np.float32(0.0), np.float32(1.0))
        near *= gap
        near[[0, 1, -2, -1]] = 0.0
        move[own[1:-1]] = np.float32(-0.5 * sign) * share * _even(near)
    points[tables.grid, 1] += tables.fall[:, None] * move


def seal(tables: ContactTables, level: float, apart: np.float32, points: Floats) -> None:
    """Draw the lips together, whatever has parted them, so that two calls leave ``1 - level`` of every gap.

    ``apart`` is for :func:`part`, which ends each round.
    """
    left = max(np.float32(0.0), np.float32(1.0) - np.float32(level))
    share = np.float32(1.0) - left ** np.float32(0.5 / SEALINGS)
    for _ in range(SEALINGS):
        move = np.zeros(tables.grid.shape[1], np.float32)
        for own, other, sign in _lips(tables):
            of_way = SEALED_ABOVE if sign > 0.0 else np.float32(1.0) - SEALED_ABOVE
            gap = gaps(tables, own, other, sign, points)
            gap[[0, -1]] = 0.0
            move[own[1:-1]] = np.float32(-sign) * of_way * share * np.maximum(_even(gap), gap[1:-1])
        points[tables.grid, 1] += tables.fall[:, None] * move
        part(tables, points, apart)


def part(tables: ContactTables, points: Floats, apart: np.float32) -> None:
    """Every vertex where the lips touch is held against the height of the other lip at its x: both give way by half.

    They are kept ``apart`` m. The two columns of the other lip between which it lies give way by shares that vanish
    where they cease to be its neighbours, so that lips that slide along each other are pushed without a jump; the
    largest push counts. Where the lips join, in the corners, both go together.
    """
    up, down = np.zeros((2, tables.grid.shape[1]), np.float32)
    lips = (
        (tables.upper, tables.lower, tables.overlap_upper, 1.0, up, down),
        (tables.lower, tables.upper, tables.overlap_lower, -1.0, down, up),
    )
    for own, other, at_rest, sign, own_push, other_push in lips:
        overlap, second, portion, inside = overlaps(_rings(tables), own, other, sign, points)
        push = np.float32(0.5) * np.maximum(overlap - at_rest + apart, np.float32(0.0))
        push *= np.clip(inside / CORNER, np.float32(0.0), np.float32(1.0)) ** 2
        push[..., [0, -1]] = 0.0
        np.maximum.at(own_push, np.broadcast_to(own, push.shape), push)
        for neighbour, share in ((second - 1, 1 - portion), (second, portion)):
            np.maximum.at(other_push, other[neighbour], push * SPREAD * np.minimum(np.float32(1.0), STEEP * share))
    move = up - down
    for end in (0, -1):
        corner = [tables.upper[end], tables.lower[end]]
        move[corner] = np.float32(0.5) * (move[corner[0]] + move[corner[1]])
    if move.any():
        points[tables.grid, 1] += tables.fall[:, None] * move


def overlaps(
    rings: Indices, own: Indices, other: Indices, sign: float, points: _Points
) -> tuple[_Points, npt.NDArray[np.int64], _Points, _Points]:
    """How far each vertex of ``own`` columns is beyond each ring of the other lip at its x, ``(rings, others, K)`` m.

    Also which of the ``other`` columns is the second of the two that it lies between, how far towards it, 0..1, and
    how far inside the ring's ends. Beyond them the overlap counts for less by as much. ``sign`` is 1 for the upper
    lip, else -1.
    """
    at, height = np.moveaxis(points[rings[:, None, own], :2], -1, 0)
    across, up = np.moveaxis(points[rings[:, other], :2], -1, 0)
    across = _in_order(across)
    before = across[None, :, None, 1:-1] >= at[..., None]
    second = np.where(before.any(-1), before.shape[-1] - before[..., ::-1].argmax(-1), 0) + 1
    ring = np.arange(len(rings))[:, None]
    first, last = across[ring, second - 1], across[ring, second]
    portion = np.clip((first - at) / np.maximum(first - last, np.float32(1e-6)), np.float32(0.0), np.float32(1.0))
    there = up[ring, second - 1] + portion * (up[ring, second] - up[ring, second - 1])
    inside = -np.maximum(at - across[:, :1], across[:, -1:] - at)
    return np.float32(sign) * (there - height) - np.maximum(-inside, np.float32(0.0)), second, portion, inside


def _in_order(across: _Points) -> _Points:
    """``(rings, K)`` m from left to right, also where a ring folds back: as far back from one end as from the other."""
    forth = np.minimum.accumulate(across, axis=1)
    back = np.maximum.accumulate(across[:, ::-1], axis=1)[:, ::-1]
    return np.float32(0.5) * (forth + back)


def _lips(tables: ContactTables) -> tuple[tuple[Indices, Indices, float], ...]:
    return (tables.upper, tables.lower, 1.0), (tables.lower, tables.upper, -1.0)


def _rings(tables: ContactTables) -> Indices:
    return tables.grid[tables.first : tables.last + 1]


def gaps(tables: ContactTables, own: Indices, other: Indices, sign: float, points: Floats) -> Floats:
    """``(K,)`` m: between each of ``own`` columns and the other lip, where they are nearest; none is negative."""
    return np.maximum(-overlaps(_rings(tables), own, other, sign, points)[0].max((0, 1)), np.float32(0.0))


def _even(heights: Floats) -> Floats:
    return np.float32(0.5) * heights[1:-1] + np.float32(0.25) * (heights[:-2] + heights[2:])
