"""``rules/bml.yaml``: what the face makes of behaviors, and how long they take."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Annotated

from pydantic import Field

from agentface.bml.block import POINTS, Aim, Nod, Show
from agentface.config import Document, Table
from agentface.conventions import SIDES
from agentface.emotion.state import ALIASES, EMOTIONS, canonical
from agentface.errors import did_you_mean
from agentface.facs.action_units import SIDE_NAMES, action_units
from agentface.motion.gestures.table import all_gestures
from agentface.resources import rules_file

FILE = "bml.yaml"
_LET_GO = "let_go"
_Part = Annotated[float, Field(gt=0, le=1)]
_Fraction = Annotated[float, Field(ge=0, le=1)]
_Seconds = Annotated[float, Field(ge=0.01, le=60)]
_HEAD_POINTS = len(POINTS["head"])


class LexemeRow(Table):
    """What a lexeme of the face shows."""

    action_units: dict[int, _Part] = {}
    emotions: dict[str, _Part] = {}
    side: Annotated[str | None, Field(pattern="^(left|right)$")] = None


class HeadRow(Table):
    """What a lexeme of the head does."""

    gesture: str
    at: Annotated[list[_Fraction], Field(min_length=_HEAD_POINTS - 2, max_length=_HEAD_POINTS - 2)]


class TargetRow(Table):
    """Where something to look at is."""

    yaw_deg: Annotated[float, Field(ge=-75, le=75)]
    pitch_deg: Annotated[float, Field(ge=-60, le=60)]
    distance_m: Annotated[float, Field(ge=0.1, le=1000)]


class BmlFile(Table):
    """The whole file."""

    times: dict[str, Annotated[list[_Seconds], Field(min_length=1)]]
    lexemes: dict[str, LexemeRow]
    heads: dict[str, HeadRow]
    targets: dict[str, TargetRow]
    influences: dict[str, _Fraction]


@dataclass(frozen=True, slots=True)
class BmlTable:
    """The file, checked.

    Attributes:
        usual_s: by kind of behavior, the seconds from one sync point to the next.
        let_go_s: what something takes to end that is replaced.
        lexemes: by name, what the face shows at an amount of 1.
        heads: by name, the gesture at an amount of 1, and the seconds from one sync point to the next.
        targets: by name.
        influences: by name, how much of the way the head turns along.
    """

    usual_s: Mapping[str, tuple[float, ...]]
    let_go_s: float
    lexemes: Mapping[str, tuple[Show, ...]]
    heads: Mapping[str, tuple[Nod, tuple[float, ...]]]
    targets: Mapping[str, Aim]
    influences: Mapping[str, float]


def known_as(name: str) -> str:
    """A name as the table writes it: ``raise-brows`` is ``RAISE_BROWS``."""
    return name.strip().upper().replace(" ", "_").replace("-", "_")


def shows(units: Iterable[tuple[int, float]], side: str | None = None) -> tuple[Show, ...]:
    """Action units at their levels, each side of the face by itself where they have sides; ``side`` is ``l`` or ``r``.

    Raises KeyError for a unit that the face does not have.
    """
    found = []
    for number, level in units:
        unit = action_units()[number]
        both = side is None and unit.has_sides and not unit.goes_aside
        found += [Show(number, level, each) for each in (SIDES if both else (side if unit.has_sides else None,))]
    return tuple(found)


def load_bml_table(path: str | Path) -> BmlTable:
    """The table at ``path``; raises DataError with every fault of it."""
    document = Document(path)
    file = document.parse(BmlFile)
    _check_times(document, file)
    gestures = all_gestures()
    for name, row in file.lexemes.items():
        _check_lexeme(document, name, row)
    for head, entry in file.heads.items():
        if entry.gesture not in gestures:
            known = did_you_mean(entry.gesture, tuple(gestures))
            document.fault(("heads", head, "gesture"), "a gesture of gestures.yaml", entry.gesture, known)
        if entry.at != sorted(entry.at):
            document.fault(("heads", head, "at"), "parts that grow", str(entry.at))
    for table in ("lexemes", "heads", "targets", "influences"):
        for name in getattr(file, table):
            if name != known_as(name):
                document.fault((table, name), known_as(name), name)
    document.check()
    return BmlTable(
        usual_s={kind: tuple(file.times[kind]) for kind in POINTS if kind in file.times},
        let_go_s=file.times[_LET_GO][0],
        lexemes={name: _shown(row) for name, row in file.lexemes.items()},
        heads={
            name: (Nod(row.gesture, 1.0), _steps(gestures[row.gesture].length_s, row.at))
            for name, row in file.heads.items()
        },
        targets={name: Aim(row.yaw_deg, row.pitch_deg, row.distance_m) for name, row in file.targets.items()},
        influences=dict(file.influences),
    )


@cache
def bml_table() -> BmlTable:
    """The table that comes with agentface, read once."""
    return load_bml_table(rules_file(FILE))


def _check_times(document: Document, file: BmlFile) -> None:
    """What times there have to be: of a head's gestures and a speech they are their own."""
    lengths = {kind: len(points) - 1 for kind, points in POINTS.items() if kind not in ("head", "speech")}
    lengths[_LET_GO] = 1
    for kind, steps in file.times.items():
        if kind not in lengths:
            document.fault(("times", kind), "no such key", kind, did_you_mean(kind, tuple(lengths)))
        elif len(steps) != lengths[kind]:
            document.fault(("times", kind), f"{lengths[kind]} times", f"{len(steps)}")
    for kind in lengths.keys() - file.times.keys():
        document.fault(("times", kind), "this key", "nothing")


def _check_lexeme(document: Document, name: str, row: LexemeRow) -> None:
    where = ("lexemes", name)
    if not row.action_units and not row.emotions:
        document.fault(where, "action_units or emotions", "neither")
    if row.side and row.emotions:
        document.fault((*where, "side"), "none beside emotions, which have no sides", row.side)
    for number in row.action_units:
        if number not in action_units():
            document.fault((*where, "action_units", number), "an action unit of action_units.yaml", str(number))
    for emotion in row.emotions:
        if emotion not in EMOTIONS:
            known = did_you_mean(emotion, (*EMOTIONS, *ALIASES))
            document.fault((*where, "emotions", emotion), "an emotion", emotion, known)


def _shown(row: LexemeRow) -> tuple[Show, ...]:
    side = SIDE_NAMES[row.side] if row.side else None
    emotions = tuple(Show(canonical(name), level) for name, level in row.emotions.items())
    return emotions + shows(row.action_units.items(), side)


def _steps(length_s: float, parts: list[float]) -> tuple[float, ...]:
    times = [0.0, *(part * length_s for part in parts), length_s]
    return tuple(later - earlier for earlier, later in pairwise(times))
