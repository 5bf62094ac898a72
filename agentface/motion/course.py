"""The contractions that the rules make of intensities on their way, as a course without corners.

The rules are asked at even ticks of time. They have corners, where one rule takes over from another; so what is shown
between two ticks is a spline of the last answers (:mod:`.answers`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.motion.answers import LATE, TICKS, Answers
from agentface.motion.intensities import Intensities
from agentface.motion.modes import ModeMean
from agentface.motion.pairs import Pairs
from agentface.parameters import MUSCLES

TICK_S = 1.0 / 120.0
LAG_S = TICKS * TICK_S
"""So long after the intensities the contractions are where they go."""
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
        self._answers = Answers(compiled=rules.compiled)
        self._asked, self._start, self._target, self._shown = (np.zeros(len(MUSCLES)) for _ in range(4))
        self._late, self._late_from, self._is_late = np.zeros(len(MUSCLES)), 0.0, False
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
        return self._target if self.settled else self._answers.at(self._part, late=True)

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
            self._answers.states[:, at_once] = self._intensities.target[at_once]
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
            self._ask(np.array([self._origin + TICK_S * number for number in range(tick - new + 1, tick + 1)]))
        self._show()

    def _ask(self, times: Doubles) -> None:
        """What the rules say at the newest ticks, less what pairs of muscles hold back."""
        states = self._intensities.at(times)[0]
        modes = self._modes.means(times, self._rules.weights(states))
        kept = slice(-(TICKS + LATE), None)
        asked, times = self._rules.course(states[kept], modes[kept]), times[kept]
        held = np.empty_like(asked)
        self._held_back(asked, self._start, self._target, self._pairs, held)
        span = self._until - self._late_from
        if span > 0.0 and self._is_late:
            held += self._late * np.maximum(self._until - times, 0.0)[:, None] / span
        self._asked = asked[-1]
        self._answers.push(states, np.minimum(np.maximum(asked - held, 0.0), asked))

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
            self._answers.contractions[:] = self._rules.course(self._answers.states)
            self._asked = self._answers.contractions[-1].copy()
        self._start = self._answers.contractions[-1].copy()
        held = np.empty((1, len(MUSCLES)))
        self._held_back(self._asked[None], self._start, self._target, self._pairs, held)
        self._late, self._late_from = self._asked - self._start - held[0], tick_at
        self._is_late = bool(self._late.any())
        self._show()

    @property
    def _part(self) -> float:
        """How much of a tick has passed since the last."""
        return min(max((self._now - self._origin) / TICK_S - self._tick, 0.0), 1.0)

    def _show(self) -> None:
        self.settled = self._answers.are_all(self._intensities.target, self._target)
        self._shown = self._target if self.settled else self._answers.at(self._part)
