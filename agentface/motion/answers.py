""":class:`Answers`: what the rules said at the last ticks of time, and a curve without corners through it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from agentface.conventions import Doubles
from agentface.emotion.state import EMOTIONS
from agentface.parameters import MUSCLES

TICKS = 5
"""Of so many answers is made what is shown between two ticks."""
LATE = 4
"""So many ticks earlier is what can be shown, too."""


class Answers:
    """The newest ``TICKS + LATE`` answers, the oldest first.

    What is shown is a running mean of three under a quadratic B-spline: it never leaves the range of the answers, its
    speed has no jumps, and it does not depend on when frames are drawn.

    Attributes:
        states: ``(TICKS + LATE, 6)``, what the rules were asked.
        contractions: ``(TICKS + LATE, len(MUSCLES))``, what came of it.
    """

    def __init__(self, *, compiled: bool) -> None:
        self.states = np.zeros((TICKS + LATE, len(EMOTIONS)))
        self.contractions = np.zeros((TICKS + LATE, len(MUSCLES)))
        self._push: Callable[..., None] = push_in_numpy
        self._are_all: Callable[..., bool] = all_in_numpy
        self._curve: Callable[..., None] = curve_in_numpy
        if compiled:
            from agentface.motion.answers_compiled import all_, curve, push

            self._push, self._are_all, self._curve = push, all_, curve

    def push(self, states: Doubles, contractions: Doubles) -> None:
        """The newest ones ``(N, 6)`` and ``(N, len(MUSCLES))``, the oldest first, of which the last few are kept."""
        self._push(self.states, states)
        self._push(self.contractions, contractions)

    def are_all(self, state: Doubles, contractions: Doubles) -> bool:
        """Whether all of them are the same ones, ``(6,)`` and ``(len(MUSCLES),)``."""
        return self._are_all(self.contractions, contractions) and self._are_all(self.states, state)

    def at(self, part: float, *, late: bool = False) -> Doubles:
        """What is shown ``(len(MUSCLES),)`` when a ``part`` 0..1 of a tick has passed, or was ``LATE`` ticks ago."""
        shown = np.empty(len(MUSCLES))
        self._curve(self.contractions[:TICKS] if late else self.contractions[LATE:], part, shown)
        return shown


def push_in_numpy(ring: Doubles, rows: Doubles) -> None:
    """Put ``rows`` at the end of ``ring``, whose first ones fall out."""
    kept = len(ring) - len(rows)
    ring[: max(kept, 0)] = ring[len(rows) :].copy()
    ring[max(kept, 0) :] = rows[max(-kept, 0) :]


def all_in_numpy(rows: Doubles, row: Doubles) -> bool:
    """Whether each of ``rows (N, M)`` is ``row (M,)``."""
    return bool((rows == row).all())


def curve_in_numpy(rows: Doubles, part: float, out: Doubles) -> None:
    """Write into ``out (M,)`` what is shown of ``rows (TICKS, M)``, a ``part`` of a tick after the last."""
    old, new = 0.5 * (1.0 - part) ** 2, 0.5 * part**2
    middle = 0.5 + part - part**2
    shares = np.array([old, middle + old, 1.0, middle + new, new]) / 3.0
    out[:] = np.where((rows == rows[0]).all(axis=0), rows[0], shares @ rows)
