"""The modes of a performance: of what a face does over time, the few movements whose sums it is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles
from agentface.io.gltf.surface import apart_mm

_NEW_MM = 0.01
"""mm: what a frame shows that is farther from all that came before is a new direction."""
_MOST = 400
_AT_ONCE = 64


@dataclass(frozen=True)
class Modes:
    """K modes and their weights in T frames.

    Attributes:
        ways: ``(K, 3 N)`` m, each scaled so that its weights reach 1 or -1.
        weights: ``(T, K)``.
        error_max_mm, error_rms_mm: how far vertices are off: the farthest, and the root of the mean square.
    """

    ways: Doubles
    weights: Doubles
    error_max_mm: float
    error_rms_mm: float


class ModeFinder:
    """Takes frames one by one and keeps of each its coordinates in a basis that grows where it has to.

    So the memory that it needs is that of the basis, of at most 400 rows, however long the performance.

    Args:
        size: the length of a row.
    """

    def __init__(self, size: int) -> None:
        self._basis = np.zeros((0, size))
        self._rows: list[Doubles] = []
        self._left: list[tuple[float, float]] = []

    def add(self, row: Doubles) -> None:
        """One frame's movement ``(3 N,)`` m from rest."""
        found, rest = self._split(row)
        off = apart_mm(rest)
        if off.max(initial=0.0) > _NEW_MM and len(self._basis) < _MOST:
            again, rest = self._split(rest)  # once more, for rounding
            size = float(np.linalg.norm(rest))
            self._basis = np.concatenate([self._basis, rest[None] / size])
            found, off = np.append(found + again, size), np.zeros(1)
        self._rows.append(found)
        self._left.append((float(off.max(initial=0.0)), float((off**2).mean()) if len(off) > 1 else 0.0))

    def modes(self, error_mm: float, most: int) -> Modes:
        """As few modes as leave no vertex of any frame farther off than ``error_mm``, and no more than ``most``."""
        count = len(self._basis)
        rows = np.stack([np.pad(row, (0, count - len(row))) for row in self._rows])
        if not count:
            return Modes(self._basis, rows, *self._sum(0.0, 0.0))
        left, sizes, right = np.linalg.svd(rows, full_matrices=False)
        weights, ways = left * sizes, right @ self._basis
        low, high = 0, min(most, len(sizes))
        while low < high:  # the fewest that will do
            middle = (low + high) // 2
            if self._sum(*self._error(weights, ways, middle))[0] <= error_mm:
                high = middle
            else:
                low = middle + 1
        errors = self._sum(*self._error(weights, ways, low))
        scale = np.maximum(np.abs(weights[:, :low]).max(axis=0), 1e-12)
        return Modes(ways[:low] * scale[:, None], weights[:, :low] / scale, *errors)

    def _split(self, row: Doubles) -> tuple[Doubles, Doubles]:
        found = self._basis @ row
        return found, row - found @ self._basis

    def _error(self, weights: Doubles, ways: Doubles, kept: int) -> tuple[float, float]:
        """The farthest in mm and the mean square in mm^2 that the modes from ``kept`` on move."""
        largest, total = 0.0, 0.0
        for start in range(0, len(weights), _AT_ONCE):
            off = apart_mm(weights[start : start + _AT_ONCE, kept:] @ ways[kept:])
            largest, total = max(largest, float(off.max(initial=0.0))), total + float((off**2).mean(axis=1).sum())
        return largest, total / len(weights)

    def _sum(self, largest: float, square: float) -> tuple[float, float]:
        """With what the basis does not hold: a bound of the farthest, and the root of the mean square."""
        most, mean = np.array(self._left).T
        return largest + float(most.max()), float(np.sqrt(square + mean.mean()))
