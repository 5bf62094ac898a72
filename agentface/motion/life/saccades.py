"""Where the eyes leap by themselves, after "Eyes Alive" (Lee, Badler and Badler, ACM TOG 21, 2002)."""

from __future__ import annotations

import math

import numpy as np

from agentface.motion.envelope import Envelope
from agentface.motion.figures import SaccadeFigures, StateRow

_HALF_BIN = 22.5
_UP, _DOWN = 90, 270


class Saccades:
    """The eyes leave what is looked at, stay aside, and come back; the head goes a part of a long way with them.

    Attributes:
        due_s: when the next leap comes, on the clock of what calls.
        eyes: yaw and pitch in radians beside what is looked at.
        head: what the head does of it.
    """

    def __init__(self, figures: SaccadeFigures, random: np.random.Generator, *, compiled: bool = False) -> None:
        self._figures, self._random = figures, random
        reach = np.radians(figures.limit_deg)
        self.eyes, self.head = (Envelope(2, -reach, reach, compiled=compiled) for _ in range(2))
        self._state: StateRow | None = None
        self._often = 1.0
        self._aside = False
        self._directions = np.array(list(figures.directions))
        self._shares = np.array(list(figures.directions.values())) / sum(figures.directions.values())
        self.due_s = math.inf

    def begin(self, now: float, state: StateRow, often: float) -> None:
        """Leap as in ``state`` from now on, ``often`` times as often."""
        self._state, self._often = state, often
        self._plan(now)

    def happen(self, now: float) -> float:
        """Leap at ``now``, to which the movements have been advanced; returns how far, in degrees."""
        self._aside = not self._aside
        far = self._go(*self._drawn() if self._aside else (0.0, 0.0))
        self._plan(now)
        return far

    def come_back(self, now: float) -> None:
        """Something is looked at anew: stay on it for a while."""
        self._aside = False
        if self.eyes.target.any():
            self._go(0.0, 0.0)
        self._plan(now)

    def rest(self) -> None:
        """Be on what is looked at, at once, and stay there."""
        self._aside, self.due_s = False, math.inf
        for envelope in (self.eyes, self.head):
            envelope.move(0.0, 0.0)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass in the movements."""
        for envelope in (self.eyes, self.head):
            if not envelope.settled:
                envelope.advance(dt)

    def _go(self, yaw: float, pitch: float) -> float:
        """Leap to an angle in degrees, and begin to turn the head; returns how far the eyes go."""
        figures = self._figures
        goal = np.radians((yaw, pitch))
        far = math.degrees(math.dist(goal, self.eyes.value))
        self.eyes.move(goal, figures.shortest_s + figures.per_degree_s * far)
        aside = math.hypot(yaw, pitch)
        part = figures.head_share * max(0.0, 1.0 - figures.head_beyond_deg / max(aside, 1e-9))
        self.head.move(part * goal, figures.head_s)
        return far

    def _drawn(self) -> tuple[float, float]:
        """Yaw and pitch in degrees of the next way aside."""
        assert self._state is not None  # noqa: S101 - for the type checker
        figures, random = self._figures, self._random
        ends = figures.chance_of(self._state.largest_deg), figures.chance_of(self._state.smallest_deg)
        size = -figures.scale_deg * math.log(random.uniform(*ends) / figures.over)
        bin_ = int(random.choice(self._directions, p=self._shares))
        if bin_ == _DOWN and random.random() < self._state.upward:
            bin_ = _UP
        angle = math.radians(bin_ + random.uniform(-_HALF_BIN, _HALF_BIN))
        wide, high = figures.limit_deg
        limit = 1.0 / math.hypot(math.cos(angle) / wide, math.sin(angle) / high)
        return min(size, limit) * math.cos(angle), min(size, limit) * math.sin(angle)

    def _plan(self, now: float) -> None:
        assert self._state is not None  # noqa: S101 - for the type checker
        mean, shortest = self._state.away_s if self._aside else self._state.at_s, self._figures.stay_s
        self.due_s = now + (shortest + (mean - shortest) * float(self._random.exponential())) / self._often
