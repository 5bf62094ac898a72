"""The default solver: the muscles swing, and the tissue is in equilibrium with them at every instant.

A frame begins where the stored responses of the muscles lead from the last one; then block descent corrects what the
responses do not know, how muscles add up, and only where that is: a batch of columns that did not move in its last turn
waits for its next one in four frames.
"""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.tissue.solvers.equilibrium import equilibrium
from agentface.tissue.tables import TissueTables

_TURNS = 4
"""Frames in which every batch has a turn."""
_RESTLESS_MM, _FAR_MM, _MORE = 0.0015, 0.007, 2
"""A batch whose last turn moved a node farther has one in every frame; beyond the second, up to so many more."""
_RESTLESS, _FAR = 1.7e-5, 1e-4
"""1/mm: the same, times the square of how far the muscles move the tissue, where that is more: what the responses miss
is of the second order."""
_LONGER = 1.8
"""Of Newton's step a column: frames that lie near to each other bear longer steps than a search from afar."""
_EVERY = 1.0
"""mm2: marks a batch that must have a turn."""
_STILL, _STILL_SPEED = 1e-3, 0.02
"""A contraction that is this near to what is asked of it, and this slow (1/s), is there."""
_SETTLED_MM = 2e-4


class BlockDescent:
    """Equilibria that follow swinging muscles; those of numpy are exact and take seconds."""

    def __init__(self, tables: TissueTables, *, compiled: bool = True) -> None:
        self._tables, self._compiled = tables, compiled
        self._moving = len(tables.columns.first) - 1
        self.positions: Floats = tables.columns.rest.copy()
        count = len(tables.loads)
        self._asked, self._place, self._speed = np.zeros(count), np.zeros(count), np.zeros(count)
        self._powers: Floats = tables.responses.powers(self._place)
        self._batches = np.arange(self._moving, dtype=np.int32)
        self._moved: Floats = np.full(self._moving, _EVERY, np.float32)
        self._largest = tables.responses.largest
        self._frame = 0
        self._settled = True

    def reset(self, contractions: Doubles) -> None:
        """Stand still in the equilibrium of ``contractions (23,)``."""
        self.positions[:] = equilibrium(self._tables, contractions, compiled=self._compiled)
        self._asked, self._place = contractions.copy(), contractions.copy()
        self._speed = np.zeros_like(self._place)
        self._powers = self._tables.responses.powers(self._place)
        self._moved[:] = _EVERY
        self._settled = True

    def step(self, contractions: Doubles, dt: float) -> None:
        """Go on by ``dt`` s: swing, and follow."""
        before = self._place
        self._place, self._speed = self._tables.swing.step(before, self._speed, self._asked, contractions, dt)
        there = (np.abs(self._place - contractions) < _STILL) & (np.abs(self._speed) < _STILL_SPEED)
        if there.all():
            self._place, self._speed = contractions.copy(), np.zeros_like(before)
        self._asked = contractions.copy()
        if not np.array_equal(self._place, before):
            self.follow(self._place)
        elif not self._settled:
            self._settle()

    def follow(self, contractions: Doubles) -> None:
        """Near to the equilibrium of ``contractions``, from where the tissue is."""
        tables = self._tables
        if not contractions.any():
            self.positions[:] = tables.columns.rest
            self._powers[:] = 0.0
            self._moved[:] = _EVERY
            self._settled = True
            return
        if not self._compiled:
            self.positions[:] = equilibrium(tables, contractions, compiled=False)
            return
        from agentface.tissue.descent_compiled import shift, sweep

        powers = tables.responses.powers(contractions)
        shift(self.positions, tables.responses.columns, powers - self._powers)
        self._powers = powers
        loads = np.tensordot(contractions.astype(np.float32), tables.loads, 1)
        self._frame = (self._frame + 1) % _TURNS
        turn = self._batches % _TURNS == self._frame
        square = float((contractions * self._largest).max()) ** 2
        restless, far = max(_RESTLESS_MM, _RESTLESS * square), max(_FAR_MM, _FAR * square)
        chosen = self._batches[turn | (self._moved > restless**2)]
        sweep(tables.columns, self.positions, loads, chosen, len(chosen), _LONGER, self._moved)
        for _ in range(_MORE):
            chosen = chosen[self._moved[chosen] > far**2]
            sweep(tables.columns, self.positions, loads, chosen, len(chosen), _LONGER, self._moved)
        self._settled = False

    def _settle(self) -> None:
        """Goes on to the equilibrium of contractions that do not change."""
        from agentface.tissue.descent_compiled import sweep

        tables = self._tables
        loads = np.tensordot(self._place.astype(np.float32), tables.loads, 1)
        sweep(tables.columns, self.positions, loads, self._batches, self._moving, _LONGER, self._moved)
        sweep(tables.columns, self.positions, loads, self._batches, self._moving, 1.0, self._moved)
        self._settled = float(self._moved.max()) < _SETTLED_MM**2
