"""How far off the shape that it is to make a movement of the tissue is, as a number with its gradient."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import EPIDERMIS

_DIRECTION = 0.8
_OUTSIDE = 1.0
_STRETCH = 1.2
_PEAK = 4.0
"""How much more the largest displacements count: they are what a stranger sees."""
_PART_OF_PEAK = 0.25
_SOFT = 0.04
"""Of the peak: what moves less has no clear direction."""
_SHORTEST_MM = 1.0


class ShapeLoss:
    """The loss of movements against a target.

    Args:
        lattice: the tissue that moves.
        target: ``(V, 3)`` mm, what the skin is to do.
    """

    def __init__(self, lattice: Lattice, target: Doubles) -> None:
        self._free, self._target = lattice.free, target
        self._size = np.linalg.norm(target, axis=1)
        self.peak = float(self._size[lattice.free].max())
        self._inside = (self._size > _PART_OF_PEAK * self.peak) & lattice.free
        self._count = int(self._inside.sum())
        present = lattice.free[lattice.edges].any(axis=1) & ~lattice.members.absent[lattice.edges].any(axis=1)
        self._edges = lattice.edges[present]
        ends = lattice.rest[EPIDERMIS][self._edges]
        self._lengths = np.maximum(np.linalg.norm(ends[:, 0] - ends[:, 1], axis=1), _SHORTEST_MM)

    def shape(self, moved: Doubles) -> tuple[float, Doubles]:
        """How far and which way the skin goes, ``moved (V, 3)`` mm, against the target; and the gradient."""
        size, inside, count = self._size, self._inside, self._count
        weight = np.where(inside, 1.0 + _PEAK * (size / self.peak) ** 4, _OUTSIDE) * self._free
        weight /= self.peak * np.sqrt(count)
        off = (moved - self._target) * weight[:, None]
        slope = 2.0 * off * weight[:, None]
        chosen, ways = moved[inside], self._target[inside] / size[inside, None]
        length = np.linalg.norm(chosen, axis=1, keepdims=True)
        soft = length + _SOFT * self.peak
        wrong = chosen / soft - ways
        part = _DIRECTION**2 / count
        value = float((off**2).sum() + part * (wrong**2).sum())
        along = (chosen * wrong).sum(axis=1, keepdims=True) / (np.maximum(length, 1e-9) * soft**2)
        slope[inside] += 2.0 * part * (wrong / soft - chosen * along)
        return value, slope

    def stretch(self, moved: Doubles) -> tuple[float, Doubles]:
        """The stretch along edges of what differs from the target, squared: no pinching; and the gradient."""
        a, b = self._edges.T
        off = (moved - self._target)[a] - (moved - self._target)[b]
        part = _STRETCH**2 / self._count
        value = part * float(((off / self._lengths[:, None]) ** 2).sum())
        pull, slope = 2.0 * part * off / self._lengths[:, None] ** 2, np.zeros_like(moved)
        np.add.at(slope, a, pull)
        np.subtract.at(slope, b, pull)
        return value, slope
