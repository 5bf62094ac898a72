"""Action units set one by one, each side by itself."""

from __future__ import annotations

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.facs.action_units import ActionUnit, action_units
from agentface.motion.envelope import Envelope
from agentface.parameters import NAMES, PARAMETERS, indices_of


class ActionUnitChannel:
    """How strongly each action unit is shown on each side, and what that moves.

    Units that contract the same muscle do not contract it twice: the largest counts. Signed movements and angles add
    up. What a unit moves in the middle of the face it moves for either side; a movement aside goes to the side that is
    shown.
    """

    def __init__(self, units: dict[int, ActionUnit] | None = None, *, compiled: bool = False) -> None:
        self._units = action_units() if units is None else units
        self._numbers = list(self._units)
        touched = {index for unit in self._units.values() for name in unit.parts for index in indices_of(name)}
        self._places = np.array(sorted(touched), np.intp)
        self.names = tuple(NAMES[place] for place in self._places)
        self._levels = Envelope(len(SIDES) * len(self._numbers), compiled=compiled)
        known = [PARAMETERS[place] for place in self._places]
        self._contracts = np.array([parameter.contracts for parameter in known])
        self._parts = np.zeros((len(self._numbers), len(SIDES), len(known)))
        for row, unit in enumerate(self._units.values()):
            for name, part in unit.parts.items():
                self._enter(row, indices_of(name), part)

    def set(self, number: int, intensity: float, side: str | None, fade: float) -> None:
        """Show one unit at ``intensity`` on side ``l`` or ``r``, or on both.

        What goes aside goes to the left where no side is named; what is one in the middle has no sides.
        """
        row = self._numbers.index(number)
        if self._units[number].goes_aside:
            side = side or SIDES[0]
        elif not self._units[number].has_sides:
            side = None
        sides = range(len(SIDES)) if side is None else [SIDES.index(side)]
        self._levels.move(intensity, fade, [len(SIDES) * row + place for place in sides])

    @property
    def shown(self) -> dict[str, float]:
        """The target intensity of each unit that has one, by its number, with a side where the other's differs."""
        found = {}
        for number, levels in zip(self._numbers, self._levels.target.reshape(-1, len(SIDES)).tolist(), strict=True):
            if levels[0] == levels[1]:
                found[str(number)] = max(levels)
            else:
                found |= {f"{number}{side}": level for side, level in zip(SIDES, levels, strict=True)}
        return {name: level for name, level in found.items() if level > 0.0}

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        self._levels.advance(dt)

    def release(self, fade: float) -> None:
        """Let go of all units."""
        self._levels.move(0.0, fade)

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """What all units move together."""
        if self._levels.resting:
            return False
        moved = self._levels.value.reshape(-1, len(SIDES), 1) * self._parts
        # of a middle movement that both sides ask for, the stronger side counts; aside, they are against each other
        each = np.maximum(moved, 0.0).max(axis=1) + np.minimum(moved, 0.0).min(axis=1)
        values[:] = np.where(self._contracts, moved.max(axis=(0, 1)), each.sum(axis=0))
        return True

    def _enter(self, row: int, indices: tuple[int, ...], part: float) -> None:
        places = [int(np.searchsorted(self._places, index)) for index in indices]
        if len(places) > 1:
            for side, place in enumerate(places):
                self._parts[row, side, place] = part
        else:
            aside = PARAMETERS[indices[0]].sideways and PARAMETERS[indices[0]].held
            self._parts[row, :, places[0]] = (part, -part if aside else part)
