"""Gestures that come by themselves: a listener's nods."""

from __future__ import annotations

import math

import numpy as np

from agentface.motion.figures import StateRow
from agentface.motion.gestures.channel import GestureChannel

_STRENGTH = (0.6, 1.0)


class Habits:
    """The gestures of a state, each at its own mean interval, exponentially; the next of them is planned.

    Attributes:
        due_s: when the next one comes, on the clock of what calls.
    """

    def __init__(self, gestures: GestureChannel, random: np.random.Generator) -> None:
        self._channel, self._random = gestures, random
        self._every: dict[str, float] = {}
        self._next = ""
        self.due_s = math.inf

    def begin(self, now: float, state: StateRow, often: float) -> None:
        """Do what is usual in ``state`` from now on, ``often`` times as often."""
        known = self._channel.gestures
        self._every = {name: every / often for name, every in state.gestures.items() if name in known}
        self._plan(now)

    def happen(self, now: float, size: float) -> None:
        """Do the next one, ``size`` 0..1 times as strongly."""
        length = self._channel.gestures[self._next].length_s
        strength = min(1.0, size * self._random.uniform(*_STRENGTH))
        self._channel.play(self._next, strength, now - self._channel.now_s)
        self._plan(now + length)

    def _plan(self, now: float) -> None:
        self.due_s = math.inf
        for name, every in self._every.items():
            due = now + every * float(self._random.exponential())
            if due < self.due_s:
                self.due_s, self._next = due, name
