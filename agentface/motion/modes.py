"""Expression modes that go over into one another: the mean of what the selector said lately.

Where one emotion takes over from another, the selector goes through all modes between them within a tenth of a second,
and the face would be another one at once. A mean over the last moments lets it come over in as much of the change's own
time as there is. While one mode is shown, it alters nothing.
"""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles
from agentface.emotion.state import EMOTIONS

LONGEST_S = 0.35
"""Over no longer than this is the mean taken; ours, by eye."""


class ModeMean:
    """The mean over a window that is none at rest and when a change is over, and never grows faster than time goes."""

    def __init__(self, tick_s: float) -> None:
        self._tick_s = tick_s
        self._ring = np.zeros((2 * math.ceil(LONGEST_S / tick_s), len(EMOTIONS), len(EMOTIONS)))
        self._since = self._until = self._window = 0.0

    @property
    def most(self) -> int:
        """Of how many ticks the means can be told at once, and over how many a mean is taken at most."""
        return len(self._ring) // 2

    def turn(self, now: float, until: float, *, at_once: bool) -> None:
        """At a tick at the time ``now`` the face has got a new way, which it will have gone by ``until``."""
        self._window = 0.0 if at_once else self._window_at(now)
        self._since, self._until = now, until

    def means(self, times: Doubles, modes: Doubles) -> Doubles:
        """Of the modes at the next ticks ``(N, 6, 6)``, which are at ``times (N,)``: likewise."""
        new = len(modes)
        self._ring[:-new], self._ring[-new:] = self._ring[new:].copy(), modes
        means = np.empty_like(modes)
        for place, time in enumerate(times.tolist()):
            means[place] = self._mean(len(self._ring) - new + place + 1, self._window_at(time) / self._tick_s)
        return means

    def _mean(self, end: int, ticks: float) -> Doubles:
        newest = self._ring[end - 1]
        if ticks <= 1.0:
            return newest
        start = max(end - math.ceil(ticks), 0)
        shares = np.minimum(ticks - np.arange(end - 1.0 - start, -1.0, -1.0), 1.0)
        mean: Doubles = np.tensordot(shares, self._ring[start:end], 1)
        whole = mean.sum()
        return mean / whole if whole > 0.0 else newest

    def _window_at(self, time: float) -> float:
        left, span = self._until - time, self._until - self._since
        if left <= 0.0 or span <= 0.0:
            return 0.0
        return min(LONGEST_S, self._window + time - self._since, max(1.0, self._window / span) * left)
