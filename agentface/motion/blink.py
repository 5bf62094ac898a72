"""One blink on request: the lids close in 80 ms, stay 30 ms, open in 170 ms.

A spontaneous blink closes about twice as fast as it opens (Evinger, Manning and Sibony, IOVS 32, 1991). While the
orbicularis oculi closes the lids, their levator rests.
"""

from __future__ import annotations

import math

from agentface.conventions import SIDES, Doubles
from agentface.motion.envelope import Envelope

CLOSE_S, HOLD_S, OPEN_S = 0.08, 0.03, 0.17
_CLOSER, _LEVATOR = (
    tuple(f"{muscle}_{side}" for side in SIDES) for muscle in ("orbicularis_oculi_palpebralis", "levator_palpebrae")
)


class BlinkChannel:
    """How far the lids are closed by a blink, 0..1: the closer contracts so far, and the levator rests as much."""

    names = (*_CLOSER, *_LEVATOR)

    def __init__(self) -> None:
        self._closure = Envelope(1)
        self._left = math.inf

    def blink(self) -> None:
        """Begin a blink; one that is on its way is begun again from where the lids are."""
        self._closure.move(1.0, CLOSE_S)
        self._left = CLOSE_S + HOLD_S

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        if self._left <= dt:
            self._closure.advance(self._left)
            dt -= self._left
            self._left = math.inf
            self._closure.move(0.0, OPEN_S)
        self._left -= dt
        self._closure.advance(dt)

    def release(self, fade: float) -> None:
        """Nothing: a blink that is on its way ends by itself."""

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """How far the closer closes, and what is left to the levator."""
        if self._closure.resting:
            return False
        closure = self._closure.value[0]
        values[: len(_CLOSER)] = closure
        values[len(_CLOSER) :] = 1.0 - closure
        return True
