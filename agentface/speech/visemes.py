"""``rules/visemes.yaml``: the fifteen visemes of MPEG-4 by number, and those that speech needs beside them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import Floats
from agentface.errors import did_you_mean
from agentface.parameters import COUNT, PARAMETERS, PLAIN_NAMES, indices_of, parameter_names
from agentface.resources import rules_file
from agentface.speech.articulators import CoarticulationRow, Dominance

VISEME_COUNT = 15
_Number = Annotated[int, Field(ge=0, lt=VISEME_COUNT)]
_Name = Annotated[str, Field(min_length=1)]


class VisemeRow(Table):
    """One viseme."""

    name: _Name
    sounds: list[str]
    examples: list[str]
    parameters: dict[str, Annotated[float, Field(ge=-1, le=1)]]
    dominance: dict[str, Dominance]
    early_s: Annotated[float, Field(ge=-0.2, le=0.2)] = 0.0
    jaw_most: Annotated[float, Field(gt=0, le=1)] = 1.0


class VisemesFile(Table):
    """``visemes.yaml``: rows by the number that FAP 1 selects, others, and what is true of all."""

    visemes: dict[_Number, VisemeRow]
    more: list[VisemeRow] = Field(default_factory=list)
    coarticulation: CoarticulationRow


@dataclass(frozen=True, slots=True, eq=False)
class Viseme:
    """What the mouth does for a sound.

    Attributes:
        number: 0 to 14, as FAP 1 selects it; None for one that is not MPEG-4's.
        name: as speech engines call it.
        sounds: phones in SAMPA.
        examples: words that have them.
        values: ``(COUNT,)`` float32, a pose.
        shares: the same by parameters without side, those that it names.
        dominance: strength, and speeds before and after in 1/s, by articulator.
        early_s: so much before the sound's middle it is shown most.
        jaw_most: 0..1, the jaw opens no farther.
    """

    number: int | None
    name: str
    sounds: tuple[str, ...]
    examples: tuple[str, ...]
    values: Floats
    shares: dict[str, float]
    dominance: dict[str, tuple[float, float, float]]
    early_s: float
    jaw_most: float


class VisemeTable(Mapping[str, Viseme]):
    """Visemes by name, those of MPEG-4 first, in the order of their numbers; ``coarticulation``: what holds for all."""

    def __init__(self, visemes: tuple[Viseme, ...], coarticulation: CoarticulationRow) -> None:
        self.numbered, self.coarticulation = visemes[:VISEME_COUNT], coarticulation
        self._named = {viseme.name: viseme for viseme in visemes}

    def __getitem__(self, name: str) -> Viseme:
        return self._named[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._named)

    def __len__(self) -> int:
        return len(self._named)


def load_visemes(path: str | Path | None = None) -> VisemeTable:
    """The table at ``path``, or the one that comes with agentface; raises DataError with every fault."""
    document = Document(path or rules_file("visemes.yaml"))
    file = document.parse(VisemesFile)
    missing = [number for number in range(VISEME_COUNT) if number not in file.visemes]
    if missing:
        document.fault(("visemes",), f"all of 0 to {VISEME_COUNT - 1}", f"none of {', '.join(map(str, missing))}")
    file.coarticulation.check(document, PLAIN_NAMES)
    taken: set[str] = set()
    for where, row in _rows(file):
        if row.name in taken:
            document.fault((*where, "name"), "each name once", row.name)
        taken.add(row.name)
        _check_parameters(document, (*where, "parameters"), row.parameters)
        file.coarticulation.check_viseme(document, where, row.parameters, row.dominance)
    document.check()
    visemes = tuple(_viseme(where, row) for where, row in _rows(file))
    return VisemeTable(visemes, file.coarticulation)


@cache
def viseme_table() -> VisemeTable:
    """The visemes that come with agentface, read once."""
    return load_visemes()


def visemes() -> tuple[Viseme, ...]:
    """MPEG-4's fifteen of those that come with agentface, by number."""
    return viseme_table().numbered


def _rows(file: VisemesFile) -> list[tuple[tuple[str, int], VisemeRow]]:
    numbered = [(("visemes", number), row) for number, row in sorted(file.visemes.items())]
    return numbered + [(("more", place), row) for place, row in enumerate(file.more)]


def _viseme(where: tuple[str, int], row: VisemeRow) -> Viseme:
    kind, number = where
    return Viseme(
        number if kind == "visemes" else None,
        row.name,
        tuple(row.sounds),
        tuple(row.examples),
        _values(row),
        dict(row.parameters),
        {name: (speeds[0], speeds[1], speeds[-1]) for name, speeds in row.dominance.items()},
        row.early_s,
        row.jaw_most,
    )


def _check_parameters(document: Document, where: tuple[str | int, ...], values: Mapping[str, float]) -> None:
    names = parameter_names()
    for name, value in values.items():
        if name not in names or name.endswith("_deg"):
            document.fault((*where, name), "a muscle or another parameter", name, did_you_mean(name, names))
            continue
        low, high = (getattr(PARAMETERS[indices_of(name)[0]], end) for end in ("low", "high"))
        if not low <= value <= high:
            document.fault((*where, name), f"a number in {low:g}..{high:g}", f"{value:g}")


def _values(row: VisemeRow) -> Floats:
    values = np.zeros(COUNT, np.float32)
    for name, value in row.parameters.items():
        values[list(indices_of(name))] = value
    values.flags.writeable = False
    return values
