"""What a reader has to say of a document: its faults, and notes of what is not shown."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from agentface.errors import DataError, Fault

_MOST = 1000


@dataclass(slots=True)
class Report:
    """Faults and notes of the file at ``path``, each with its line; of either at most the first 1 000."""

    path: Path
    faults: list[Fault] = field(default_factory=list)
    notes: list[Fault] = field(default_factory=list)

    def tell(self, line: int | None, where: str, expected: str, got: str, hint: str = "") -> None:
        """Remember what is not allowed."""
        if len(self.faults) < _MOST:
            self.faults.append(Fault(self.path, line, where, expected, got, hint))

    def note(self, line: int | None, where: str, expected: str, got: str, hint: str = "") -> None:
        """Remember what is allowed, and not shown as it is written."""
        if len(self.notes) < _MOST:
            self.notes.append(Fault(self.path, line, where, expected, got, hint))

    def check(self) -> None:
        """Raise DataError if there is any fault, with all of them by their lines."""
        if self.faults:
            raise DataError(sorted(self.faults, key=lambda fault: fault.line or 0))
