"""Tables of comma-separated values, row by row: the columns that are wanted, as numbers, every fault with its line."""

from __future__ import annotations

import csv
import math
import re
from array import array
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from agentface.errors import FaultList, shown
from agentface.io.performances.reading import MOST_FRAMES

MOST_COLUMNS = 20_000
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_NOTHING = ("", "nan", "null", "none", "na")


@dataclass(frozen=True, slots=True)
class TableRow:
    """One row: its line in the file, and its fields, as many as the table has columns."""

    line: int
    fields: list[str]


class CsvTable:
    """A table whose first line names its columns; blanks around names and values do not count.

    Args:
        lines: without their ends, from the beginning of the file.
        faults: gets every fault; one that makes the rest unreadable raises DataError.
    """

    def __init__(self, lines: Iterable[str], faults: FaultList) -> None:
        self._faults = faults
        self._lines = enumerate(lines, start=1)
        number, head = next(((number, line) for number, line in self._lines if line.strip()), (None, ""))
        if number is None:
            faults.stop(None, "", "a line that names the columns", "an empty file")
        self.columns = [name.strip() for name in self._split(number, head)]
        self.line = number
        if len(self.columns) > MOST_COLUMNS:
            faults.stop(number, "", f"at most {MOST_COLUMNS:,} columns", len(self.columns))

    def place(self, *names: str) -> int | None:
        """Where the first column with one of these names stands, letters' case aside; None without any."""
        lowered = [name.lower() for name in self.columns]
        return next((lowered.index(name.lower()) for name in names if name.lower() in lowered), None)

    def need(self, *names: str) -> int:
        """As :meth:`place`; a column that is missing is a fault that ends the reading."""
        place = self.place(*names)
        if place is None:
            self._faults.stop(self.line, names[0], "a column of this name", "none")
        return place

    def rows(self) -> Iterator[TableRow]:
        """The rows; one that has more or fewer fields than there are columns is a fault, and left out."""
        for count, (number, line) in enumerate(self._lines):
            if not line.strip():
                continue
            if count >= MOST_FRAMES:
                self._faults.stop(number, "", f"at most {MOST_FRAMES:,} rows", "more")
            fields = self._split(number, line)
            if len(fields) == len(self.columns):
                yield TableRow(number, fields)
            else:
                self._faults.tell(number, "", f"{len(self.columns)} fields, as the first line names", len(fields))

    def numbers(self, row: TableRow, places: Sequence[int], into: array[float] | None = None) -> list[float] | None:
        """The numbers at some places, also put at the end of ``into``; None, and a fault, where there is none."""
        found: list[float] = []
        for place in places:
            value = self.number(row, place)
            if value is None:
                return None
            found.append(value)
        if into is not None:
            into.extend(found)
        return found

    def number(self, row: TableRow, place: int) -> float | None:
        """The finite number at one place; None, and a fault, where there is none."""
        text = row.fields[place].strip()
        value = float(text) if len(text) <= 60 and _NUMBER.fullmatch(text) else math.nan
        if math.isfinite(value):
            return value
        self._faults.tell(row.line, self.columns[place], "a finite number", shown(text))
        return None

    def empty(self, row: TableRow, places: Iterable[int]) -> bool:
        """Whether any of these fields says that there is nothing."""
        return any(row.fields[place].strip().lower() in _NOTHING for place in places)

    def _split(self, number: int, line: str) -> list[str]:
        try:
            return next(csv.reader([line]), [])
        except csv.Error as error:
            self._faults.stop(number, "", "comma-separated values", str(error))
