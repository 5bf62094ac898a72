"""Clocks, passed in wherever time is read, so that tests and films own the time."""

from __future__ import annotations

import time
from typing import Protocol

from agentface.conventions import check_rate


class Clock(Protocol):
    """A clock for durations and one for dates."""

    def now(self) -> float:
        """Seconds since some instant; never runs backward."""

    def date(self) -> float:
        """Seconds since 1 January 1970, UTC."""

    def sleep(self, seconds: float) -> None:
        """Wait; a clock may wake up earlier, when there is something to do."""


class SystemClock:
    """The clock of the machine."""

    def now(self) -> float:
        """Seconds since some instant; never runs backward."""
        return time.perf_counter()

    def date(self) -> float:
        """Seconds since 1 January 1970, UTC."""
        return time.time()

    def sleep(self, seconds: float) -> None:
        """Wait."""
        time.sleep(max(0.0, seconds))


class FrameClock:
    """A clock for what is not made in real time: whole frames, ``fps`` a second; waiting takes none.

    Raises InvalidValueError for a rate that is none.
    """

    def __init__(self, fps: float) -> None:
        self._fps = check_rate("fps", fps)
        self._frame = 0

    def now(self) -> float:
        """The frames so far, in seconds."""
        return self._frame / self._fps

    def date(self) -> float:
        """The same: such a clock begins in 1970."""
        return self.now()

    def sleep(self, seconds: float) -> None:
        """Go to the frame that is nearest to so many seconds from now, and at least to the next one."""
        self._frame += max(1, round(seconds * self._fps))
