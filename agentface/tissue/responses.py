"""What each muscle alone does to the tissue, as a polynomial of its contraction: where equilibria are looked for."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.tissue.columns import Columns, packed
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import HYPODERMIS
from agentface.tissue.relaxation import relax

LEVELS = (0.5, 1.0)
"""Contractions whose equilibria the polynomials go through, beside rest."""
_POWERS = np.arange(1, len(LEVELS) + 1)


class Responses(NamedTuple):
    """``columns (46, N)`` float32 mm: for each muscle, what its contraction counts for, and that squared."""

    columns: Floats

    def powers(self, contractions: Doubles) -> Floats:
        """``(46,)``: what each column counts for."""
        return (contractions[:, None] ** _POWERS).ravel().astype(np.float32)

    @property
    def largest(self) -> Doubles:
        """``(23,)`` mm: how far each muscle, fully contracted, moves a coordinate at most."""
        whole = self.columns.reshape(-1, len(LEVELS), self.columns.shape[1]).sum(axis=1)
        return np.abs(whole).max(axis=1).astype(np.float64)


def linear(lattice: Lattice, columns: Columns, forces: Doubles) -> Responses:
    """The responses to ``forces (23, V, 3)`` as far as the tissue at rest is linear, in numpy."""
    from agentface.tissue.newton import factors, solve

    factored, moving, rows = factors(lattice, lattice.points), len(columns.first) - 1, []
    for pull in forces:
        load = np.zeros_like(lattice.rest)
        load[HYPODERMIS] = pull
        moved = solve(lattice, factored, load.reshape(-1, 3)).reshape(lattice.rest.shape)
        once = packed(columns.vertex, moved)[:moving].ravel()
        rows += [once, *(0.0 * once for _ in LEVELS[1:])]
    return Responses(np.array(rows, np.float32))


def measure(columns: Columns, loads: Floats) -> Responses:
    """The responses to ``loads (23, B, 3, LANES)``, from equilibria."""
    moving = len(columns.first) - 1
    inverse = np.linalg.inv(np.array(LEVELS)[:, None] ** _POWERS)
    rows = []
    for load in loads:
        positions, before = columns.rest.copy(), 0.0
        moved: list[Floats] = []
        for level in LEVELS:
            if before:
                positions[:moving] += (level / before - 1.0) * moved[-1].reshape(positions[:moving].shape)
            relax(columns, positions, load * np.float32(level), tolerance=1e-3)
            moved.append((positions - columns.rest)[:moving].ravel())
            before = level
        rows += list(inverse @ np.stack(moved))
    return Responses(np.array(rows, np.float32))
