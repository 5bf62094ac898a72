"""Expression modes that go over into one another: the mean of what the selector said lately.

Where one emotion takes over from another, the selector goes through all modes between them within a tenth of a second,
and the face would be another one at once. A mean over the last moments lets it come over in as much of the change's own
time as there is. While one mode is shown, it alters nothing.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from agentface.conventions import Doubles
from agentface.emotion.state import EMOTIONS

LONGEST_S = 0.35
"""Over no longer than this is the mean taken; ours, by eye."""


class ModeMean:
    """The mean over a window that is none at rest and when a change is over, and never grows faster than time goes.

    ``mean`` takes it, ``mean_in_numpy`` or its compiled twin.
    """

    def __init__(self, tick_s: float, mean: Callable[..., None]) -> None:
        self._tick_s, self._mean = tick_s, mean
        self.most = math.ceil(LONGEST_S / tick_s)
        """Over how many ticks a mean is taken at most, and of how many the means can be told at once."""
        self._told = np.zeros((8 * self.most, len(EMOTIONS), len(EMOTIONS)))
        self._count = self.most
        self._since = self._until = self._window = 0.0

    def turn(self, now: float, until: float, *, at_once: bool) -> None:
        """At a tick at the time ``now`` the face has got a new way, which it will have gone by ``until``."""
        self._window = 0.0 if at_once else self._window_at(now)
        self._since, self._until = now, until

    def means(self, times: Doubles, modes: Doubles) -> Doubles:
        """Of the modes at the next ticks ``(N, 6, 6)``, which are at ``times (N,)``: likewise."""
        if self._count + len(modes) > len(self._told):
            self._told[: self.most] = self._told[self._count - self.most : self._count]
            self._count = self.most
        self._told[self._count : self._count + len(modes)] = modes
        means = np.empty_like(modes)
        for place, time in enumerate(times.tolist()):
            self._count += 1
            self._mean(self._told, self._count, self._window_at(time) / self._tick_s, means[place])
        return means

    def _window_at(self, time: float) -> float:
        left, span = self._until - time, self._until - self._since
        if left <= 0.0 or span <= 0.0:
            return 0.0
        return min(LONGEST_S, self._window + time - self._since, max(1.0, self._window / span) * left)


def mean_in_numpy(told: Doubles, end: int, ticks: float, out: Doubles) -> None:
    """Write into ``out (6, 6)`` the mean of the last so many ticks of ``told (N, 6, 6)`` before ``end``.

    Of a tick that is only in part among them, that part counts; without any, or where no mode is shown, the last one.
    """
    out[:] = told[end - 1]
    if ticks > 1.0:
        ages = np.arange(math.ceil(ticks) - 1.0, -1.0, -1.0)
        mean = np.tensordot(np.minimum(ticks - ages, 1.0), told[end - len(ages) : end], 1)
        if (whole := mean.sum()) > 0.0:
            out[:] = mean / whole
