"""A clock that tests move."""

from __future__ import annotations


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
