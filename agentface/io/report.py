"""What a reader has to say of a document: its faults, and notes of what is not shown."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from itertools import islice
from pathlib import Path

from agentface.errors import DataError, Fault, did_you_mean

_MOST = 1000
_MOST_NAMES = 100
_LONGEST = 1000


@dataclass(slots=True)
class Report:
    """Faults and notes of the file at ``path``, each with its line; of either at most the first 1 000."""

    path: Path
    faults: list[Fault] = field(default_factory=list)
    notes: list[Fault] = field(default_factory=list)
    _demands: bool = False

    @contextmanager
    def demanding(self) -> Iterator[None]:
        """In this block, what is not shown as it is written is a fault."""
        self._demands = True
        try:
            yield
        finally:
            self._demands = False

    def tell(self, line: int | None, where: str, expected: str, got: str, hint: str = "") -> None:
        """Remember what is not allowed."""
        if len(self.faults) < _MOST:
            self.faults.append(self._fault(line, where, expected, got, hint))

    def note(self, line: int | None, where: str, expected: str, got: str, hint: str = "") -> None:
        """Remember what is allowed, and not shown as it is written."""
        if self._demands:
            self.tell(line, where, expected, got, hint)
            return
        if len(self.notes) < _MOST:
            self.notes.append(self._fault(line, where, expected, got, hint))

    def _fault(self, line: int | None, *texts: str) -> Fault:
        where, expected, got, hint = (text[:_LONGEST] for text in texts)
        return Fault(self.path, line, where[:_MOST_NAMES], expected, got, hint)

    def near(self, got: str, known: Iterable[str]) -> str:
        """As :func:`agentface.errors.did_you_mean`, of the first 100 names; nothing where no more is told."""
        if len(self.faults) + len(self.notes) >= _MOST:
            return ""
        names = list(islice(known, _MOST_NAMES))
        return did_you_mean(got[:_MOST_NAMES], names) if names else ""

    def check(self) -> None:
        """Raise DataError if there is any fault, with all of them by their lines."""
        if self.faults:
            raise DataError(sorted(self.faults, key=lambda fault: fault.line or 0))
