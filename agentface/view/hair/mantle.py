"""How high the outside of long hair lies over the head: one smooth surface that all cards of a side follow."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles
from agentface.head.look import HairLook
from agentface.mesh.smoothstep import smoothstep
from agentface.view.hair.hull import Hull
from agentface.view.hair.locks import Locks
from agentface.view.hair.sheets import WAVE_OUT, resampled, risen, volume

_ROWS = 40
"""Along the hair."""
LOW = 0.86
"""How high the lowest cards lie, as a part of the hair's thickness."""
_TUCKED, _AT_FACE = 0.58, 0.22
"""How high the first of them lies, as a part of the hair's thickness; the part of the side that is at the face."""
_LOWEST, _LOWEST_WAY = (0.001, 0.0046), 0.03
"""Metres over the hull at the root and beyond, above the sheets below; metres from the root between these."""
_EASED = 3, 4
"""Columns, and points of each, by which what lifts one of them goes farther."""
_BULGE, _BULGED = 0.0016, (0.15, 0.6)
"""Metres by which the middle of a lock stands out, and the parts of its length between which it comes to that."""


@dataclass(frozen=True, slots=True)
class Mantle:
    """``heights (C, U)`` m over the ``ground``, and ``whole (C, U)`` m how thick hair is, at places evenly apart.

    The ground is the head without what is small: hair that swings aside keeps its height.
    """

    ground: Hull

    heights: Doubles
    whole: Doubles
    locks: Locks

    @classmethod
    def drawn(cls, hull: Hull, look: HairLook, paths: Doubles, locks: Locks, thickness: float) -> Mantle:
        """Of hair that falls along ``paths (C, K, 3)`` m on the ``hull``."""
        place = np.linspace(0.0, 1.0, len(paths))
        points, along = resampled(paths, np.tile(np.linspace(0.0, 1.0, _ROWS), (len(paths), 1)))
        tucked = _TUCKED + (1.0 - _TUCKED) * smoothstep(0.0, _AT_FACE, place)[:, None]
        whole = thickness * tucked * risen(place, along) * volume(hull, points)
        swung = look.curl * WAVE_OUT * locks.waves(place, along)[1]
        # where the lowest have to be lifted all are, so that they stay in their order
        lowest = points + (LOW * whole + swung)[..., None] * hull.outward(points)
        lift = np.linalg.norm(hull.push_out(lowest, least_height(along)) - lowest, axis=2)
        ground = hull.smoother()
        return cls(ground, ground.height(points) + whole + swung + _eased(lift), whole, locks)

    def at(self, place: Doubles, part: Doubles) -> Doubles:
        """Metres over the hull at ``place (...)`` of the side and ``part (...)`` of the length, in its locks."""
        bulge = _BULGE * self.locks.inside(place) * smoothstep(*_BULGED, part)
        return _read(self.heights, place, part) + bulge

    def thickness(self, place: Doubles, part: Doubles) -> Doubles:
        """Metres of hair there."""
        return _read(self.whole, place, part)


def least_height(along: Doubles) -> Doubles:
    """Metres that cards lie over the hull at least, ``along`` m from their roots."""
    return np.asarray(_LOWEST[0] + (_LOWEST[1] - _LOWEST[0]) * smoothstep(0.0, _LOWEST_WAY, along))


def _read(table: Doubles, place: Doubles, part: Doubles) -> Doubles:
    columns, rows = table.shape[0] - 1, table.shape[1] - 1
    across, along = np.clip(columns * place, 0, columns - 1e-6), np.clip(rows * part, 0, rows - 1e-6)
    c, r = across.astype(int), along.astype(int)
    u, v = across - c, along - r
    first = (1.0 - v) * table[c, r] + v * table[c, r + 1]
    second = (1.0 - v) * table[c + 1, r] + v * table[c + 1, r + 1]
    return np.asarray((1.0 - u) * first + u * second)


def _eased(lift: Doubles) -> Doubles:
    """``(C, U)``: what lifts hair over an ear lifts what is beside it too, less and less."""
    for axis, times in ((0, _EASED[0]), (1, _EASED[1])):
        size = lift.shape[axis]
        before, behind = np.maximum(np.arange(size) - 1, 0), np.minimum(np.arange(size) + 1, size - 1)
        for _ in range(times):
            lift = np.maximum(lift, np.maximum(lift.take(before, axis), lift.take(behind, axis)))
        for _ in range(2 * times):
            lift = 0.5 * lift + 0.25 * (lift.take(before, axis) + lift.take(behind, axis))
    return lift
