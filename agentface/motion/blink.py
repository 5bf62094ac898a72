"""Blinks: the lids close in about 80 ms, stay 30 ms, open in 170 ms.

A blink closes about twice as fast as it opens (Evinger, Manning and Sibony, IOVS 32, 1991). While the
orbicularis oculi closes the lids, their levator rests.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

from agentface.conventions import SIDES, Doubles
from agentface.motion.envelope import Envelope

CLOSE_S, HOLD_S, OPEN_S = 0.08, 0.03, 0.17
_CLOSER, _LEVATOR = (
    tuple(f"{muscle}_{side}" for side in SIDES) for muscle in ("orbicularis_oculi_palpebralis", "levator_palpebrae")
)


class BlinkShape(NamedTuple):
    """One blink: how far it closes the lids, 0..1, and in how many seconds it closes, stays and opens."""

    depth: float = 1.0
    close_s: float = CLOSE_S
    hold_s: float = HOLD_S
    open_s: float = OPEN_S


class BlinkChannel:
    """How far the lids are closed by a blink, 0..1: the closer contracts so far, and the levator rests as much.

    Attributes:
        lags_s: how much later than told the left and the right eye do it.
        begun: called with each blink when the first lid begins to close.
    """

    names = (*_CLOSER, *_LEVATOR)

    def __init__(self, *, compiled: bool = False) -> None:
        self.lags_s: tuple[float, ...] = (0.0,) * len(SIDES)
        self.begun: list[Callable[[BlinkShape], object]] = []
        self._closure = Envelope(len(SIDES), compiled=compiled)
        self._now = 0.0
        self._asked: list[tuple[float, int, BlinkShape]] = []
        self._open_at = [math.inf] * len(SIDES)
        self._open_s = [OPEN_S] * len(SIDES)

    @property
    def now_s(self) -> float:
        """The seconds that have passed."""
        return self._now

    def blink(self, shape: BlinkShape | None = None, in_s: float = 0.0) -> None:
        """Begin a blink ``in_s`` seconds from now; one that is on its way then begins again from where the lids are."""
        for side, lag in enumerate(self.lags_s):
            due = self._now + in_s + lag
            if due <= self._now:
                self._close(side, shape or BlinkShape())
            else:
                self._asked.append((due, side, shape or BlinkShape()))
        self._asked.sort()

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        end = self._now + dt
        while (due := self._due()) <= end:
            self._closure.advance(due - self._now)
            self._now = due
            if self._asked and self._asked[0][0] <= due:
                _, side, shape = self._asked.pop(0)
                self._close(side, shape)
            else:
                self._open(self._open_at.index(due))
        if not self._closure.settled:
            self._closure.advance(end - self._now)
        self._now = end

    def release(self, fade: float) -> None:
        """Nothing: a blink that is on its way ends by itself."""

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """How far the closer closes what is open, and what is left to the levator."""
        if self._closure.resting:
            return False
        closure = self._closure.value
        values[: len(SIDES)] = 1.0
        weights[: len(SIDES)] = closure
        values[len(SIDES) :] = 1.0 - closure
        return True

    def _due(self) -> float:
        return min(self._asked[0][0] if self._asked else math.inf, *self._open_at)

    def _close(self, side: int, shape: BlinkShape) -> None:
        self._closure.move(shape.depth, shape.close_s, [side])
        self._open_at[side] = self._now + shape.close_s + shape.hold_s
        self._open_s[side] = shape.open_s
        if side == self.lags_s.index(min(self.lags_s)):
            for tell in self.begun:
                tell(shape)

    def _open(self, side: int) -> None:
        self._closure.move(0.0, self._open_s[side], [side])
        self._open_at[side] = math.inf
