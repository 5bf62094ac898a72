"""The paper's semi-implicit integration of the whole tissue (Zhang, Prakash and Sung, section 4)."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.tissue.columns import new_forces
from agentface.tissue.solvers.equilibrium import equilibrium
from agentface.tissue.tables import TissueTables

STABLE = 0.1
"""The longest time step that no lattice tried has diverged with, in units of the root of mass over a stiffness of 1."""


def stable_step(tables: TissueTables) -> float:
    """The longest time step, in s, that is taken; longer ones are divided."""
    return STABLE * math.sqrt(tables.mass)


def divided(tables: TissueTables, before: Doubles, after: Doubles, dt: float) -> Iterator[tuple[Doubles, float]]:
    """The contractions ``(23,)`` and the time of each of the equal steps that ``dt`` s take; none for no time."""
    count = max(1, math.ceil(dt / stable_step(tables) - 1e-9))
    for index in range(1, count + 1 if dt > 0.0 else 1):
        yield before + index / count * (after - before), dt / count


class SemiImplicit:
    """Eq. 12 and 13 on every node: mass, inertia and all."""

    def __init__(self, tables: TissueTables) -> None:
        self._tables = tables
        self._moving = len(tables.columns.first) - 1
        self.positions: Floats = tables.columns.rest.copy()
        self._ahead = self.positions.copy()
        self._velocities: Floats = np.zeros_like(self.positions[: self._moving])
        self._forces = new_forces(tables.columns)
        self._contractions = np.zeros(len(tables.loads))

    def reset(self, contractions: Doubles) -> None:
        """Stand still in the equilibrium of ``contractions (23,)``."""
        self.positions[:] = equilibrium(self._tables, contractions)
        self._ahead[:] = self.positions
        self._velocities[:] = 0.0
        self._contractions = contractions.copy()

    def step(self, contractions: Doubles, dt: float) -> None:
        """Go on by ``dt`` s, in as many equal steps as stability asks for."""
        for there, part in divided(self._tables, self._contractions, contractions, dt):
            self.iterate(there, part)
        self._contractions = contractions.copy()

    def iterate(self, contractions: Doubles, dt: float) -> None:
        """One step of ``dt`` s, not longer than :func:`stable_step`."""
        from agentface.tissue.solvers.semi_implicit_compiled import move

        tables = self._tables
        loads = np.tensordot(contractions.astype(np.float32), tables.loads, 1)
        state = (self.positions, self._velocities, self._ahead, loads, self._forces)
        move(tables.columns, *state, 0, self._moving, False, dt, tables.mass, tables.drag)
