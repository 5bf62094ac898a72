"""The contractions that the rules make of intensities on their way, as a course without corners.

The rules are asked at even ticks of time. They have corners, where one rule takes over from another; so what is shown
between two ticks is a spline of the last ``TICKS`` answers: a running mean of three under a quadratic B-spline. It
never leaves the range of the answers, its speed has no jumps, and it does not depend on when frames are drawn.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.emotion.state import EMOTIONS
from agentface.motion.intensities import Intensities
from agentface.motion.modes import ModeMean
from agentface.motion.pairs import Pairs
from agentface.parameters import MUSCLES

TICK_S = 1.0 / 120.0
TICKS = 5
LAG_S = TICKS * TICK_S
"""So long after the intensities the contractions are where they go."""
LATE = 4
LATE_S = LATE * TICK_S
"""So much later :attr:`Course.late` shows the same."""
_NEARLY = 1e-6
"""Of a tick: sums of frame times are not exact."""
_LIKE = 0.05
"""Modes whose weights differ by less are the same."""


class EmotionRules(Protocol):
    """What turns emotions into contractions: ``agentface.emotion.inference.Inference``."""

    @property
    def compiled(self) -> bool:
        """Whether kernels do it."""

    def weights(self, states: Doubles) -> Doubles:
        """How much of each expression mode states ``(N, 6)`` show: ``(N, 6, 6)``."""

    def course(self, states: Doubles, weights: Doubles | None = None) -> Doubles:
        """The contractions of states ``(N, 6)``, in modes of ``weights``: ``(N, len(MUSCLES))`` in 0..1."""


class Course:
    """The contractions while ``intensities`` move; ``settled`` once they are where they go.

    ``held_back`` is what ``pairs`` hold back, ``held_back_in_numpy`` or its compiled twin.
    """

    def __init__(
        self,
        rules: EmotionRules,
        intensities: Intensities,
        modes: ModeMean,
        pairs: Pairs,
        held_back: Callable[..., None],
    ) -> None:
        self._rules, self._intensities, self._modes = rules, intensities, modes
        self._pairs, self._held_back = pairs, held_back
        self.settled = True
        self._turned = self._rewritten = False
        self._states = np.zeros((TICKS + LATE, len(EMOTIONS)))
        self._answers = np.zeros((TICKS + LATE, len(MUSCLES)))
        self._spline = np.zeros(TICKS)
        self._asked, self._start, self._target, self._shown = (np.zeros(len(MUSCLES)) for _ in range(4))
        self._late, self._late_from = np.zeros(len(MUSCLES)), 0.0
        self._origin = self._now = self._until = 0.0
        self._tick = 0

    @property
    def shown(self) -> Doubles | None:
        """``(len(MUSCLES),)``, what they are now; None while all are 0 and stay there."""
        if self._rewritten:
            self._aim()
        return None if self.settled and not self._target.any() else self._shown

    @property
    def late(self) -> Doubles:
        """``(len(MUSCLES),)``, what they were ``LATE_S`` ago."""
        late: Doubles = self._target if self.settled else self._spline @ self._answers[:TICKS]
        return late

    def takes_over(self, now: float, places: npt.NDArray[np.intp], levels: Doubles) -> bool:
        """Whether other modes take over where the intensities at ``places`` go to ``levels``."""
        states = np.stack([self._intensities.at(np.array([now]))[0][0], self._intensities.target])
        states[1, places] = levels
        before, after = self._rules.weights(states)
        return bool(before.any() and after.any() and np.abs(before - after).max() > _LIKE)

    def turn(self, now: float, at_once: npt.NDArray[np.intp], until: float) -> None:
        """The intensities were told something new, and all is to be done by the time ``until``.

        Those ``at_once`` count as if they had always been there.
        """
        self._now, self._until = now, until
        if self.settled:
            self._origin, self._tick, self.settled = now, 0, False
        self._turned = True
        if at_once.size:
            self._states[:, at_once] = self._intensities.target[at_once]
            self._rewritten = True

    def advance(self, now: float) -> None:
        """Go on to the time ``now`` in seconds."""
        self._now = now
        if self._turned:
            self._aim()
        if self.settled:
            return
        tick = math.floor((now - self._origin) / TICK_S + _NEARLY)
        new = min(tick - self._tick, self._modes.most)
        self._tick = tick
        if new:
            self._ask(self._origin + TICK_S * np.arange(tick - new + 1.0, tick + 1.0))
        if (self._answers == self._target).all() and (self._states == self._intensities.target).all():
            self._settle()
        else:
            self._show()

    def _ask(self, times: Doubles) -> None:
        """What the rules say at the newest ticks, less what pairs of muscles hold back."""
        states = self._intensities.at(times)[0]
        kept = len(self._answers)
        modes = self._modes.means(times, self._rules.weights(states))[-kept:]
        states, times = states[-kept:], times[-kept:]
        asked = self._rules.course(states, modes)
        held = np.empty_like(asked)
        self._held_back(asked, self._start, self._target, self._pairs, held)
        span = self._until - self._late_from
        if span > 0.0:
            held += self._late * np.maximum(self._until - times, 0.0)[:, None] / span
        self._asked = asked[-1]
        _push(self._states, states)
        _push(self._answers, np.minimum(np.maximum(asked - held, 0.0), asked))

    def _aim(self) -> None:
        """Take in what is new: where the contractions go, and from where.

        What was held back until now goes on being so, and is let go by and by, lest the face jumps.
        """
        self._turned = False
        tick_at = self._origin + self._tick * TICK_S
        self._modes.turn(tick_at, self._until, at_once=self._rewritten)
        self._target = self._rules.course(self._intensities.target[None])[0]
        if self._rewritten:
            self._rewritten = False
            self._answers[:] = self._rules.course(self._states)
            self._asked = self._answers[-1].copy()
        self._start = self._answers[-1].copy()
        held = np.empty((1, len(MUSCLES)))
        self._held_back(self._asked[None], self._start, self._target, self._pairs, held)
        self._late, self._late_from = self._asked - self._start - held[0], tick_at
        if (self._answers == self._target).all() and (self._states == self._intensities.target).all():
            self._settle()
        else:
            self._show()

    def _settle(self) -> None:
        self.settled, self._shown = True, self._target

    def _show(self) -> None:
        part = min(max((self._now - self._origin) / TICK_S - self._tick, 0.0), 1.0)
        old, new = 0.5 * (1.0 - part) ** 2, 0.5 * part**2
        self._spline[:] = old, 0.5 + part - part**2 + old, 1.0, 0.5 + part - part**2 + new, new
        self._spline /= 3.0
        newest = self._answers[LATE:]
        self._shown = self._target if (newest == self._target).all() else self._spline @ newest


def _push(ring: Doubles, rows: Doubles) -> None:
    """Put ``rows`` at the end of ``ring``, whose first ones fall out."""
    new = len(rows)
    ring[:-new], ring[-new:] = ring[new:].copy(), rows
