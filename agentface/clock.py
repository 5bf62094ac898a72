"""Clocks, passed in wherever time is read, so that tests and recordings own the time."""

from __future__ import annotations

import time
from typing import Protocol


class Clock(Protocol):
    """A clock for durations and one for dates."""

    def now(self) -> float:
        """Seconds since some instant; never runs backward."""

    def date(self) -> float:
        """Seconds since 1 January 1970, UTC."""

    def sleep(self, seconds: float) -> None:
        """Wait."""


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


class ManualClock:
    """A clock that moves only when it is told to; waiting moves it."""

    def __init__(self, start: float = 0.0, date: float = 1_000_000_000.0) -> None:
        self._now, self._offset = start, date - start

    def now(self) -> float:
        """The seconds it was moved, plus ``start``."""
        return self._now

    def date(self) -> float:
        """The date it was given at the start, plus the seconds it was moved."""
        return self._now + self._offset

    def sleep(self, seconds: float) -> None:
        """Move the clock on."""
        self._now += max(0.0, seconds)
