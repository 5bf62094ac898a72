"""What the rows of a table become: frames in the order of time, and notes about the rows that are left out."""

from __future__ import annotations

from array import array
from collections.abc import Iterable

import numpy as np

from agentface.conventions import Doubles
from agentface.errors import Fault, FaultList
from agentface.motion.performance import LONGEST_S


class SeenFrames:
    """Rows of numbers with their times, which have to increase.

    Args:
        faults: gets what is wrong.
    """

    def __init__(self, faults: FaultList) -> None:
        self._faults = faults
        self._times, self._numbers = array("d"), array("d")
        self._left: dict[tuple[str, str], tuple[int, int]] = {}

    @property
    def last_s(self) -> float:
        """The time of the newest frame; minus infinity before the first."""
        return self._times[-1] if self._times else -np.inf

    def add(self, line: int, time_s: float, numbers: Iterable[float]) -> None:
        """One frame; a time that is not later than the one before, or out of all range, is a fault."""
        if time_s <= self.last_s:
            expected = f"a time after that of the row before, {self.last_s:.9g} s"
            self._faults.tell(line, "", expected, f"{time_s:.9g} s")
        elif not 0.0 <= time_s <= LONGEST_S:
            self._faults.tell(line, "", f"a time in 0..{LONGEST_S:g} s", f"{time_s:.9g} s")
        else:
            self._times.append(time_s)
            self._numbers.extend(numbers)

    def note(self, line: int, expected: str, got: str) -> None:
        """Something of a row that is not used; the same of other rows is counted, and told once."""
        first, count = self._left.get((expected, got), (line, 0))
        self._left[expected, got] = first, count + 1

    @property
    def notes(self) -> tuple[Fault, ...]:
        """What was noted, each with its first line."""
        return tuple(
            Fault(self._faults.file, line, "", expected, f"{got}, in {count} row{'s' * (count > 1)}")
            for (expected, got), (line, count) in self._left.items()
        )

    def done(self) -> tuple[Doubles, Doubles]:
        """Times ``(T,)`` and numbers ``(T, N)``; raises DataError for any fault, and when there is no frame."""
        self._faults.check()
        if not self._times:
            why = f" ({'; '.join(str(note) for note in self.notes)})" if self.notes else ""
            self._faults.stop(None, "", "at least one frame", f"none{why}")
        return np.array(self._times), np.array(self._numbers).reshape(len(self._times), -1)
