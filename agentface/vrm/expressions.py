"""``rules/vrm.yaml``: the preset expressions of VRM, and what the face does for each."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field

from agentface.config import Document, Table
from agentface.emotion.state import EMOTIONS
from agentface.errors import did_you_mean
from agentface.resources import rules_file
from agentface.speech.visemes import viseme_table

VRM_FILE = "vrm.yaml"
PRESETS = (
    *("happy", "angry", "sad", "relaxed", "surprised", "neutral", "aa", "ih", "ou", "ee", "oh"),
    *("blink", "blinkLeft", "blinkRight", "lookUp", "lookDown", "lookLeft", "lookRight"),
)
"""The eighteen of VRM 1.0 (VRMC_vrm-1.0, expressions)."""
_Emotion = Literal["happiness", "sadness", "anger", "fear", "disgust", "surprise"]
_Eye = Literal["left", "right"]
_Share = Annotated[float | int, Field(gt=0.0, le=1.0)]
_Way = Annotated[float | int, Field(ge=-1.0, le=1.0)]


class _Row(Table):
    vrm0: Annotated[str, Field(min_length=1)]
    emotions: dict[_Emotion, _Share] = Field(default_factory=dict)
    viseme: str | None = None
    closes: list[_Eye] = Field(default_factory=list)
    looks: Annotated[list[_Way], Field(min_length=2, max_length=2)] | None = None


class _File(Table):
    expressions: dict[str, _Row]
    felt: dict[_Emotion, dict[str, _Share]]
    neck: Annotated[float | int, Field(ge=0.0, le=1.0)]


@dataclass(frozen=True, slots=True)
class Preset:
    """A preset, and what the face does for it: one of four things, or nothing.

    Attributes:
        name: VRM 1.0's.
        vrm0: VRM 0's, which the VMC protocol uses.
        emotions: 0..1 by emotion, as far as it is a mixture of these.
        viseme: the name of one.
        closes: the eyes, ``left`` and ``right``, whose lids it closes.
        looks: the eyes' way to the person's left and up, -1..1 to the side of their hole.
    """

    name: str
    vrm0: str
    emotions: Mapping[str, float]
    viseme: str | None
    closes: tuple[str, ...]
    looks: tuple[float, float] | None


class ExpressionTable(Mapping[str, Preset]):
    """The presets by VRM 1.0's names.

    Attributes:
        felt: 0..1 by preset, for each of the six emotions.
        neck: 0..1, the part of the head's turn that is the neck's.
    """

    def __init__(self, expressions: tuple[Preset, ...], felt: Mapping[str, Mapping[str, float]], neck: float) -> None:
        self.neck = neck
        self.felt = {emotion: dict(shares) for emotion, shares in felt.items()}
        self._named = {expression.name: expression for expression in expressions}

    def __getitem__(self, name: str) -> Preset:
        return self._named[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._named)

    def __len__(self) -> int:
        return len(self._named)


def load_expressions(path: str | Path) -> ExpressionTable:
    """The table at ``path``; raises DataError with every fault of it."""
    document = Document(path)
    file = document.parse(_File)
    _check_names(document, ("expressions",), file.expressions, PRESETS, all_of_them=True)
    _check_names(document, ("felt",), file.felt, EMOTIONS, all_of_them=True)
    for emotion, shares in file.felt.items():
        _check_names(document, ("felt", emotion), shares, PRESETS)
    _check_rows(document, file)
    document.check()
    expressions = tuple(_expression(name, file.expressions[name]) for name in PRESETS)
    return ExpressionTable(expressions, {str(emotion): shares for emotion, shares in file.felt.items()}, file.neck)


def _check_names(
    document: Document, where: tuple[str, ...], names: Iterable[str], known: Sequence[str], *, all_of_them: bool = False
) -> None:
    given = tuple(names)
    for name in given:
        if name not in known:
            document.fault((*where, name), "one of these names", repr(name), did_you_mean(name, known))
    for name in known if all_of_them else ():
        if name not in given:
            document.fault((*where, name), "this key", "nothing")


def _check_rows(document: Document, file: _File) -> None:
    taken: set[str] = set()
    for name, row in file.expressions.items():
        where = ("expressions", name)
        if row.viseme is not None and row.viseme not in viseme_table():
            known = tuple(viseme_table())
            document.fault((*where, "viseme"), "a viseme", repr(row.viseme), did_you_mean(row.viseme, known))
        if sum(map(bool, (row.emotions, row.viseme, row.closes, row.looks))) > 1:
            document.fault(where, "one of emotions, viseme, closes and looks", "several")
        if row.vrm0 in taken:
            document.fault((*where, "vrm0"), "each name once", row.vrm0)
        taken.add(row.vrm0)


def _expression(name: str, row: _Row) -> Preset:
    looks = None if row.looks is None else (float(row.looks[0]), float(row.looks[1]))
    emotions = {str(emotion): float(share) for emotion, share in row.emotions.items()}
    return Preset(name, row.vrm0, emotions, row.viseme, tuple(map(str, row.closes)), looks)


@cache
def expression_table() -> ExpressionTable:
    """The table that comes with agentface, read once."""
    return load_expressions(rules_file(VRM_FILE))
