"""Muscles and the jaw set one by one."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.motion.envelope import Envelope
from agentface.parameters import NAMES, PARAMETERS, indices_of

_HELD = tuple(known for known in PARAMETERS if known.held)


class MuscleChannel:
    """Parameters set by hand, gaze and head excepted: such a one leaves whatever else moves it until it is released."""

    names = tuple(known.name for known in _HELD)

    def __init__(self, *, compiled: bool = False) -> None:
        low, high = [known.low for known in _HELD], [known.high for known in _HELD]
        self._value = Envelope(len(_HELD), low, high, compiled=compiled)
        self._weight = Envelope(len(_HELD), compiled=compiled)

    def set(self, name: str, value: float, fade: float) -> None:
        """Hold a parameter (both sides where none is named) at ``value``."""
        places = _places(name)
        unused = places[self._weight.value[places] == 0.0]
        self._value.move(value, 0.0, unused)
        self._value.move(value, fade, places)
        self._weight.move(1.0, fade, places)

    def release(self, fade: float, name: str | None = None) -> None:
        """Give one parameter, or all, back to the other channels."""
        self._weight.move(0.0, fade, slice(None) if name is None else _places(name))

    @property
    def held(self) -> dict[str, float]:
        """The parameters that are set, and the value that each goes to."""
        return {self.names[place]: float(self._value.target[place]) for place in np.flatnonzero(self._weight.target)}

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        self._value.advance(dt)
        self._weight.advance(dt)

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """What is held, as far as it is."""
        if self._weight.resting:
            return False
        values[:] = self._value.value
        weights[:] = self._weight.value
        return True


def _places(name: str) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    return np.array([MuscleChannel.names.index(NAMES[index]) for index in indices_of(name)])
