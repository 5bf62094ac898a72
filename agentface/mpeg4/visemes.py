"""``rules/visemes.yaml``: the fifteen visemes of MPEG-4, and FAP 1, which blends two of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import Floats
from agentface.errors import InvalidValueError, did_you_mean
from agentface.parameters import COUNT, PARAMETERS, indices_of, parameter_names
from agentface.resources import rules_file

VISEME_COUNT = 15
BLEND_STEPS = 63
"""The largest blend of FAP 1 and the largest intensity of FAP 2: six bits."""
_Number = Annotated[int, Field(ge=0, lt=VISEME_COUNT)]


class VisemeRow(Table):
    """One viseme."""

    name: Annotated[str, Field(min_length=1)]
    sounds: list[str]
    examples: list[str]
    parameters: dict[str, Annotated[float, Field(ge=-1, le=1)]]


class VisemesFile(Table):
    """``visemes.yaml``: rows by the number that FAP 1 selects."""

    visemes: dict[_Number, VisemeRow]


@dataclass(frozen=True, slots=True, eq=False)
class Viseme:
    """What the mouth does for a sound.

    Attributes:
        number: 0 to 14, as FAP 1 selects it.
        name: as speech engines call it.
        sounds: phones in SAMPA.
        examples: words that have them.
        values: ``(COUNT,)`` float32, a pose.
    """

    number: int
    name: str
    sounds: tuple[str, ...]
    examples: tuple[str, ...]
    values: Floats


def load_visemes(path: str | Path | None = None) -> tuple[Viseme, ...]:
    """The table at ``path``, or the one that comes with agentface, by number; raises DataError with every fault."""
    document = Document(path or rules_file("visemes.yaml"))
    file = document.parse(VisemesFile)
    missing = [number for number in range(VISEME_COUNT) if number not in file.visemes]
    if missing:
        document.fault(("visemes",), f"all of 0 to {VISEME_COUNT - 1}", f"none of {', '.join(map(str, missing))}")
    names = parameter_names()
    for number, row in file.visemes.items():
        for name, value in row.parameters.items():
            where = ("visemes", number, "parameters", name)
            if name not in names or name.endswith("_deg"):
                document.fault(where, "a muscle or another parameter", name, did_you_mean(name, names))
                continue
            low, high = (getattr(PARAMETERS[indices_of(name)[0]], end) for end in ("low", "high"))
            if not low <= value <= high:
                document.fault(where, f"a number in {low:g}..{high:g}", f"{value:g}")
    document.check()
    return tuple(
        Viseme(number, row.name, tuple(row.sounds), tuple(row.examples), _values(row))
        for number, row in sorted(file.visemes.items())
    )


@cache
def visemes() -> tuple[Viseme, ...]:
    """The visemes that come with agentface, read once."""
    return load_visemes()


def _values(row: VisemeRow) -> Floats:
    values = np.zeros(COUNT, np.float32)
    for name, value in row.parameters.items():
        values[list(indices_of(name))] = value
    values.flags.writeable = False
    return values


def viseme_pose(first: int, second: int, blend: int, table: tuple[Viseme, ...] | None = None) -> Floats:
    """FAP 1: ``(COUNT,)`` float32, the first viseme by ``blend`` of 63 and the second by the rest.

    Raises InvalidValueError for numbers that are no visemes, and for a blend outside 0..63.
    """
    known = visemes() if table is None else table
    for what, number, largest in (
        ("viseme_select1", first, VISEME_COUNT - 1),
        ("viseme_select2", second, VISEME_COUNT - 1),
        ("viseme_blend", blend, BLEND_STEPS),
    ):
        check_step(what, number, largest)
    share = np.float32(blend / BLEND_STEPS)
    return np.asarray(share * known[first].values + (np.float32(1.0) - share) * known[second].values)


def check_step(what: str, number: int, largest: int) -> None:
    """Raise InvalidValueError for what is no whole number in ``0..largest``."""
    if isinstance(number, bool) or number != int(number) or not 0 <= number <= largest:
        raise InvalidValueError(what, f"a whole number in 0..{largest}", number)
