"""The shape in which nothing moves any more, found by block descent, as exactly as single precision goes."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.tissue.columns import Columns

LONGER = 1.7
"""Of Newton's step a column: over-relaxation."""
_PATIENCE, _LOST_MM = 60, 1e3
_RISE = 0.2, 0.4, 0.6, 0.8
_LAST = 4
"""Sweeps of plain steps that end a search: they take out what over-relaxation leaves swinging."""


def new_loads(columns: Columns, forces: Doubles) -> Floats:
    """Forces on the hypodermis ``(..., V, 3)`` in the form of kernels, ``(..., B, 3, LANES)``."""
    chosen = columns.vertex[: len(columns.first) - 1]
    rows = np.where((chosen >= 0)[..., None], forces[..., np.maximum(chosen, 0), :], 0.0)
    return np.ascontiguousarray(np.swapaxes(rows, -1, -2), np.float32)


def relax(
    columns: Columns, positions: Floats, loads: Floats, tolerance: float = 1e-4, most: int = 3000
) -> tuple[int, float]:
    """Moves ``positions`` to equilibrium under ``loads``: until no sweep moves a node by ``tolerance`` mm.

    Returns how many sweeps it took, and the largest step of the last one.
    """
    from agentface.tissue.descent_compiled import sweep

    count, longer = len(columns.first) - 1, LONGER
    batches, moved = np.arange(count, dtype=np.int32), np.zeros(count, np.float32)
    best = np.inf
    for done in range(1, most + 1):
        sweep(columns, positions, loads, batches, count, longer, moved)
        step = float(moved.max()) ** 0.5
        if step < tolerance or not step < _LOST_MM:
            break
        if done % _PATIENCE == 0:  # a node between two places swings for ever under long steps
            longer = longer if step < 0.5 * best else 1.0 + 0.6 * (longer - 1.0)
            best = min(best, step)
    for _ in range(_LAST):
        sweep(columns, positions, loads, batches, count, 1.0, moved)
    return done, float(moved.max()) ** 0.5


def gradually(columns: Columns, loads: Floats) -> Floats:
    """The equilibrium under ``loads``, raised from rest step by step."""
    there = columns.rest.copy()
    for part in _RISE:
        relax(columns, there, loads * np.float32(part), tolerance=1e-2, most=200)
    relax(columns, there, loads, tolerance=2e-5, most=4000)
    return there
