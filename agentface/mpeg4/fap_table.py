"""``rules/faps.yaml``: the table of the facial animation parameters of MPEG-4 (ISO/IEC 14496-2, Table C-1)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from agentface.config import Document, Table
from agentface.resources import rules_file

FAP_COUNT = 68
HIGH_LEVEL = 2
"""FAPs 1 and 2 choose visemes and expressions; those after them move feature points."""
FapUnit = Literal["IRISD", "ES", "ENS", "MNS", "MW", "AU", "none"]
"""What a value is counted in; AU is 1e-5 radians. FAPs 1 and 2 have no unit."""
Motion = Literal["up", "down", "left", "right", "forward", "growing", "rolled up", "none"]
"""Where a positive value goes; left and right are the person's."""

_Number = Annotated[int, Field(ge=1, le=FAP_COUNT)]
_Range = Annotated[list[int], Field(min_length=2, max_length=2)]


class FapRow(Table):
    """One FAP; those of the first group have neither points nor unit nor range."""

    name: Annotated[str, Field(pattern=r"^[a-z][a-z_]*$")]
    description: Annotated[str, Field(min_length=1)]
    group: Annotated[int, Field(ge=1, le=10)]
    points: list[Annotated[str, Field(pattern=r"^\d{1,2}\.\d{1,2}$")]] = []
    unit: FapUnit = "none"
    positive: Motion = "none"
    bidirectional: bool = True
    quantiser: Annotated[int, Field(ge=1)] = 1
    intra: _Range = [0, 0]
    predicted: _Range = [0, 0]


class FapsFile(Table):
    """``faps.yaml``: rows by number."""

    faps: dict[_Number, FapRow]


@dataclass(frozen=True, slots=True)
class Fap:
    """A facial animation parameter.

    Attributes:
        number: 1 to 68.
        name: as in the standard, in lower case.
        description: what moves.
        group: 1 to 10.
        points: the feature points that it moves, such as ``2.1``.
        unit: the FAPU of its values.
        positive: where a positive value goes.
        bidirectional: whether it has negative values.
        quantiser: the step of the coded stream, in units.
        intra, predicted: the least and the largest quantised value in frames that stand alone, and in differences.
    """

    number: int
    name: str
    description: str
    group: int
    points: tuple[str, ...]
    unit: FapUnit
    positive: Motion
    bidirectional: bool
    quantiser: int
    intra: tuple[int, int]
    predicted: tuple[int, int]

    @property
    def low(self) -> int:
        """The least value, in units."""
        return self.quantiser * self.intra[0]

    @property
    def high(self) -> int:
        """The largest value, in units."""
        return self.quantiser * self.intra[1]


def load_faps(path: str | Path | None = None) -> tuple[Fap, ...]:
    """The table at ``path``, or the one that comes with agentface, in the order of the numbers.

    Raises DataError with every fault: numbers that are missing, names given twice, ranges that are none.
    """
    document = Document(path or rules_file("faps.yaml"))
    file = document.parse(FapsFile)
    missing = [number for number in range(1, FAP_COUNT + 1) if number not in file.faps]
    if missing:
        document.fault(("faps",), f"all of 1 to {FAP_COUNT}", f"none of {', '.join(map(str, missing))}")
    names: dict[str, int] = {}
    for number, row in sorted(file.faps.items()):
        if row.name in names:
            document.fault(("faps", number, "name"), "a name of its own", row.name, f"that of {names[row.name]}")
        names.setdefault(row.name, number)
        _check_row(document, number, row)
    document.check()
    return tuple(_fap(number, row) for number, row in sorted(file.faps.items()))


def _check_row(document: Document, number: int, row: FapRow) -> None:
    low_level = number > HIGH_LEVEL
    for key in ("points", "unit", "positive"):
        if (getattr(row, key) in ("none", [])) == low_level:
            expected = "this key, as it moves feature points" if low_level else "no such key, as it moves none"
            document.fault(("faps", number, key), expected, "nothing" if low_level else repr(getattr(row, key)))
    if not low_level:
        return
    for key in ("intra", "predicted"):
        low, high = getattr(row, key)
        if not (low < high and low <= 0 <= high):
            document.fault(
                ("faps", number, key), "the least and the largest value, with 0 in between", f"{low}, {high}"
            )
    if row.bidirectional != (min(row.intra) < 0):
        expected = "a negative value" if row.bidirectional else "0"
        document.fault(("faps", number, "intra", 0), f"{expected}, as bidirectional says", str(row.intra[0]))


def _fap(number: int, row: FapRow) -> Fap:
    ranges = (row.intra[0], row.intra[1]), (row.predicted[0], row.predicted[1])
    of_points = tuple(row.points), row.unit, row.positive, row.bidirectional
    return Fap(number, row.name, row.description, row.group, *of_points, row.quantiser, *ranges)
