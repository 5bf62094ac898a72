"""When a face blinks by itself, and how."""

from __future__ import annotations

import math

import numpy as np

from agentface.motion.blink import BlinkChannel, BlinkShape
from agentface.motion.figures import LifeTable, StateRow, drawn


class Blinks:
    """Blinks at the rate of the state, some of them with leaps of the gaze and at the ends of sentences.

    Stays between them are exponential beyond the shortest one. A leap that asks for a blink brings the next one
    forward, and the others come so much rarer that the rate is kept.

    Attributes:
        due_s: when the next one comes, on the clock of what calls.
    """

    def __init__(self, table: LifeTable, channel: BlinkChannel, random: np.random.Generator) -> None:
        self._figures, self._saccades = table.blinks, table.saccades
        self._channel, self._random = channel, random
        self._mean_s = math.inf
        self._last = -math.inf
        self.due_s = math.inf

    def begin(self, now: float, state: StateRow, often: float) -> None:
        """Blink as in ``state`` from now on, ``often`` times as often."""
        self._mean_s = self._alone_s(state) / often
        self._plan(now)

    def happen(self, now: float) -> None:
        """Blink at ``now``, which is not before the channel's own."""
        figures, random = self._figures, self._random
        shape = BlinkShape(1.0, *(drawn(random, span) for span in (figures.close_s, figures.hold_s, figures.open_s)))
        kind = random.random()
        if kind < figures.half:
            shape = shape._replace(depth=drawn(random, figures.half_depth))
        self._blink(now, shape)
        if kind > 1.0 - figures.double:
            self._blink(now + drawn(random, figures.double_after_s), shape)
        self._plan(now)

    def shifted(self, now: float, degrees: float) -> None:
        """The gaze leaps: the further, the likelier it brings a blink."""
        self._perhaps(now, min(self._figures.per_degree * degrees, self._figures.most))

    def sentence_ended(self, now: float) -> None:
        """A sentence ends: likewise."""
        self._perhaps(now, self._figures.sentence_end)

    def _perhaps(self, now: float, chance: float) -> None:
        asked = self._random.random() < chance
        if asked and now - self._last >= self._figures.apart_s:
            self.happen(now)

    def _blink(self, at: float, shape: BlinkShape) -> None:
        self._channel.blink(shape, at - self._channel.now_s)
        self._last = at

    def _plan(self, now: float) -> None:
        self.due_s = max(now, self._last + self._figures.apart_s) + self._mean_s * float(self._random.exponential())

    def _alone_s(self, state: StateRow) -> float:
        """The mean stay beyond the shortest, where leaps of the state's own gaze bring some of the blinks."""
        figures, saccades = self._figures, self._saccades
        blinks = 60.0 * (1.0 + figures.double) / state.blinks_per_minute
        least = saccades.chance_of(state.smallest_deg)
        mean_degrees = saccades.scale_deg * (1.0 + math.log(saccades.over / least))
        leaps = 2.0 / (state.at_s + state.away_s) * min(figures.per_degree * mean_degrees, figures.most)
        rest = 1.0 / max(blinks - figures.apart_s, 1e-3) - leaps
        return 1.0 / max(rest, 1e-2)
