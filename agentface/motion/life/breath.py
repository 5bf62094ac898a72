"""Breathing: each breath has its own length and depth."""

from __future__ import annotations

import math

import numpy as np

from agentface.motion.figures import BreathFigures, drawn


class Breath:
    """In, faster, and out: how full the chest is, and how fast air goes in, both 0..1.

    Attributes:
        due_s: when the next breath begins, on the clock of what calls.
    """

    def __init__(self, figures: BreathFigures, random: np.random.Generator) -> None:
        self._figures, self._random = figures, random
        self._start, self._depth = 0.0, 0.0
        self.due_s = 0.0

    def happen(self, now: float) -> None:
        """Begin the next breath."""
        self._start, self._depth = now, drawn(self._random, self._figures.depth)
        self.due_s = now + 60.0 / drawn(self._random, self._figures.per_minute)

    def at(self, now: float) -> tuple[float, float]:
        """How full, and how fast air goes in."""
        u = (now - self._start) / max(self.due_s - self._start, 1e-9)
        part = self._figures.in_share
        if u <= 0.0:
            return 0.0, 0.0
        if u < part:
            turn = math.pi * u / part
            return self._depth * (0.5 - 0.5 * math.cos(turn)), self._depth * math.sin(turn) ** 2
        return self._depth * (0.5 + 0.5 * math.cos(math.pi * min((u - part) / (1.0 - part), 1.0))), 0.0
