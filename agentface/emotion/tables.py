"""The two rule files as they are written: their models, and every fault of both at once.

``emotions.yaml`` gives each emotion a row a muscle, of five contraction sets; ``blends.yaml`` says for each pair
of emotions which of the two has the upper face, the lids and the lower face.
"""

from __future__ import annotations

from collections import Counter
from itertools import combinations, pairwise
from pathlib import Path
from typing import Annotated, Any

from pydantic import AfterValidator, BeforeValidator, Field

from agentface.config import Document, Model, Table
from agentface.emotion.sets import CONTRACTION_SETS, INTENSITY_SETS, ContractionSet, IntensitySet
from agentface.emotion.state import EMOTIONS, canonical
from agentface.errors import UnknownNameError, did_you_mean
from agentface.parameters import MUSCLES

STRONGER, REST = "stronger", "rest"
_PARTS = ("upper", "lids", "lower")


def _muscle(name: str) -> str:
    if name not in MUSCLES:
        raise ValueError(f"expected a muscle without its side; {did_you_mean(name, MUSCLES)}")
    return name


def _emotion(name: Any) -> Any:
    try:
        return canonical(name) if isinstance(name, str) and name not in (STRONGER, REST) else name
    except UnknownNameError as error:
        raise ValueError(f"expected an emotion, {STRONGER} or {REST}; {error.hint}") from None


def _row(row: list[str]) -> list[str]:
    if row[0] != CONTRACTION_SETS[0]:
        raise ValueError(f"expected {CONTRACTION_SETS[0]} at {INTENSITY_SETS[0]}: no emotion, no contraction")
    for column, (low, high) in enumerate(pairwise(row)):
        # Steps this small keep every ramp below 0.05 for 0.01 in intensity, the selector included.
        if abs(CONTRACTION_SETS.index(high) - CONTRACTION_SETS.index(low)) > (2 if column == 0 else 1):
            step = f"{low} at {INTENSITY_SETS[column]} and {high} at {INTENSITY_SETS[column + 1]}"
            raise ValueError(
                f"expected neighbours one set apart (the first step: two), lest the face jumps; not {step}"
            )
    return row


def _contribution(value: Any) -> Any:
    return {"from": value} if isinstance(value, str) else value


MuscleName = Annotated[str, AfterValidator(_muscle)]
Row = Annotated[
    list[ContractionSet], Field(min_length=len(INTENSITY_SETS), max_length=len(INTENSITY_SETS)), AfterValidator(_row)
]
Donor = Annotated[str, BeforeValidator(_emotion)]


class EmotionTable(Table):
    """The single expression of one emotion: a row a muscle, its columns the intensity sets."""

    description: str
    source: str
    muscles: dict[MuscleName, Row] = Field(min_length=1)


class Emotions(Table):
    """The six single expressions."""

    happiness: EmotionTable
    sadness: EmotionTable
    anger: EmotionTable
    fear: EmotionTable
    disgust: EmotionTable
    surprise: EmotionTable


class EmotionsFile(Table):
    """``emotions.yaml``."""

    columns: list[IntensitySet]
    emotions: Emotions


class Selector(Table):
    """``gap``: by how much an emotion trails the strongest when single expression and blend weigh the same."""

    gap: float = Field(ge=0.2, le=0.5)


class Groups(Table):
    """The muscles of the three parts of the face."""

    upper: list[MuscleName]
    lids: list[MuscleName]
    lower: list[MuscleName]


class Contribution(Table):
    """Whose rows some muscles follow, and the contraction set beyond which they do not go.

    In the file, the name of the donor alone is enough.
    """

    donor: Donor = Field(alias="from")
    at_most: ContractionSet = "VeryBig"


Given = Annotated[Contribution, BeforeValidator(_contribution)]


class BlendTable(Table):
    """The blend of two emotions: who gives each part of the face, and which muscles differ from that."""

    description: str
    source: str
    upper: Given
    lids: Given
    lower: Given
    exceptions: dict[MuscleName, Given] = Field(default={}, alias="except")


class BlendsFile(Table):
    """``blends.yaml``."""

    selector: Selector
    groups: Groups
    blends: dict[str, BlendTable]


def load_emotions(path: str | Path) -> EmotionsFile:
    """The single expressions at ``path``; raises DataError with every fault found."""
    document = Document(path)
    file = document.collect(EmotionsFile)
    columns = _at(document.data, "columns")
    if columns is not None and columns != list(INTENSITY_SETS):
        document.fault(("columns",), f"[{', '.join(INTENSITY_SETS)}]", str(columns))
    return _checked(document, file)


def load_blends(path: str | Path) -> BlendsFile:
    """The blends at ``path``; raises DataError with every fault found."""
    document = Document(path)
    file = document.collect(BlendsFile)
    _check_groups(document)
    _check_pairs(document)
    return _checked(document, file)


def pair_of(key: str) -> tuple[str, ...] | None:
    """The two emotions that ``fear+sadness`` names, in the order of ``EMOTIONS``; None if it names no pair."""
    parts = key.split("+")
    try:
        named = {canonical(part) for part in parts}
    except UnknownNameError:
        return None
    return tuple(sorted(named, key=EMOTIONS.index)) if len(parts) == len(named) == 2 else None


def _check_groups(document: Document) -> None:
    groups = _at(document.data, "groups")
    if not isinstance(groups, dict):
        return
    rows = {group: row for group in _PARTS if isinstance(row := groups.get(group), list)}
    named = Counter(muscle for row in rows.values() for muscle in row if isinstance(muscle, str))
    for group, row in rows.items():
        for place, muscle in enumerate(row):
            if isinstance(muscle, str) and named[muscle] > 1:
                document.fault(("groups", group, place), "each muscle in one group, once", repr(muscle))
    missing = [muscle for muscle in MUSCLES if muscle not in named]
    if missing:
        document.fault(("groups",), "every muscle in one of the groups", f"none for {', '.join(missing)}")


def _check_pairs(document: Document) -> None:
    blends = _at(document.data, "blends")
    if not isinstance(blends, dict):
        return
    seen: set[tuple[str, ...]] = set()
    for key, blend in blends.items():
        if not isinstance(key, str):
            continue
        pair = pair_of(key)
        if pair is None:
            document.fault(("blends", key), "two emotions joined by +", repr(key), f"emotions: {', '.join(EMOTIONS)}")
            continue
        if pair in seen:
            document.fault(("blends", key), "each pair of emotions once", "the pair a second time")
        seen.add(pair)
        _check_donors(document, key, pair, blend)
    for pair in combinations(EMOTIONS, 2):
        if pair not in seen:
            document.fault(("blends", "+".join(pair)), "this blend", "nothing", "all fifteen pairs are needed")


def _check_donors(document: Document, key: str, pair: tuple[str, ...], blend: Any) -> None:
    exceptions = _at(blend, "except")
    given: dict[tuple[str, ...], Any] = {(part,): _at(blend, part) for part in _PARTS}
    given |= {
        ("except", muscle): value for muscle, value in (exceptions if isinstance(exceptions, dict) else {}).items()
    }
    for where, value in given.items():
        donor = _at(value, "from") if isinstance(value, dict) else value
        try:
            foreign = isinstance(donor, str) and donor not in (STRONGER, REST) and canonical(donor) not in pair
        except UnknownNameError:
            continue
        if foreign:
            document.fault(("blends", key, *where), f"{' or '.join(pair)}, {STRONGER} or {REST}", repr(donor))


def _at(data: Any, key: str) -> Any:
    return data.get(key) if isinstance(data, dict) else None


def _checked(document: Document, file: Model | None) -> Model:
    document.check()
    if file is None:
        raise AssertionError("unreachable: a document without faults was parsed")
    return file
