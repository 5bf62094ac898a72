"""What the words of vocabularies for emotions mean to the face: mixtures, by ``rules/vocabularies.yaml``.

Source: Vocabularies for EmotionML, W3C Note 1 April 2014.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated, Literal, TypeAlias

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from agentface.config import Document, Table
from agentface.conventions import Doubles
from agentface.emotion.mixture import mixtures
from agentface.emotion.state import ALIASES, EMOTIONS, NEUTRAL
from agentface.resources import rules_file

TYPES = ("category", "dimension", "appraisal", "action-tendency")
"""The four ways of describing an emotion; the names of EmotionML's elements."""
Mixture: TypeAlias = Mapping[str, float]
"""Shares 0..1 of emotions, or of ``neutral``."""

_PAD = "pad-dimensions"
_DOUBT = 0.3
"""What an appraisal that is not made holds back an emotion, in parts of what it would weigh."""
_NAME = re.compile(r"[\w.:-]+")


def is_word(text: str) -> bool:
    """Whether it may name an item of a vocabulary: an NMTOKEN of XML, no blanks in it."""
    return _NAME.fullmatch(text) is not None


def _word(name: str) -> str:
    if not is_word(name):
        raise ValueError("expected a word without blanks")
    return name


Name = Annotated[str, AfterValidator(_word)]
Coordinate = Annotated[float, Field(ge=-1.0, le=1.0)]
Share = Annotated[float, Field(gt=0.0, le=1.0)]
Six = Annotated[list[Coordinate], Field(min_length=6, max_length=6)]


class WordRow(Table):
    """A category or an action tendency: a mixture, or a point of pleasure, arousal and dominance."""

    shows: dict[str, Share] | None = None
    pad: Annotated[list[Coordinate], Field(min_length=3, max_length=3)] | None = None
    source: str

    @model_validator(mode="after")
    def _one_of_them(self) -> WordRow:
        if (self.shows is None) == (self.pad is None):
            raise ValueError("expected one of shows and pad")
        return self


class ScaleRow(Table):
    """A dimension or an appraisal: where each of the six stands on it."""

    scale: Literal["unipolar", "bipolar"]
    six: Six
    source: str


class WordsTable(Table):
    """A vocabulary of words."""

    type: Literal["category", "action-tendency"]
    items: Annotated[dict[Name, WordRow], Field(min_length=1)]


class ScalesTable(Table):
    """A vocabulary of scales."""

    type: Literal["dimension", "appraisal"]
    items: Annotated[dict[Name, ScaleRow], Field(min_length=1)]


class VocabulariesFile(Table):
    """``rules/vocabularies.yaml``."""

    columns: list[str]
    sources: Annotated[dict[str, str], Field(min_length=1)]
    vocabularies: dict[Name, Annotated[WordsTable | ScalesTable, Field(discriminator="type")]]


@dataclass(frozen=True)
class Words:
    """A vocabulary of categories or action tendencies; ``mixtures`` has what each word shows."""

    type: str
    mixtures: Mapping[str, Mixture]

    @property
    def names(self) -> tuple[str, ...]:
        """The words of the vocabulary, in its order."""
        return tuple(self.mixtures)


@dataclass(frozen=True)
class Scales:
    """A vocabulary of dimensions or appraisals.

    Attributes:
        type: ``dimension`` or ``appraisal``.
        names: the scales.
        bipolar: ``(M,)``, whether a scale's middle is nought.
        six: ``(M, 6)``, where each of the six emotions stands, -1..1.
    """

    type: str
    names: tuple[str, ...]
    bipolar: np.ndarray[tuple[int], np.dtype[np.bool_]]
    six: Doubles

    def shown(self, values: Mapping[str, Doubles]) -> Doubles:
        """Weights of the six, ``(T, 6)``, for values 0..1, ``(T,)`` each, of some of the scales."""
        given = [self.names.index(name) for name in values]
        levels = np.column_stack(list(values.values()))
        levels = np.where(self.bipolar[given], 2.0 * levels - 1.0, levels)
        if self.type == "appraisal":
            unknown = np.delete(self.six, given, axis=0)
            return mixtures(levels, self.six[given], _DOUBT * (unknown**2).sum(axis=0))
        points = np.zeros((len(levels), len(self.names)))
        points[:, given] = levels
        return mixtures(points, self.six)

    def says(self, name: str) -> bool:
        """Whether the face shows anything of a scale."""
        return bool(self.six[self.names.index(name)].any())


Vocabulary: TypeAlias = Words | Scales


def load_vocabularies(path: str | Path) -> dict[str, Vocabulary]:
    """The vocabularies of the file at ``path``; raises DataError with every fault of it."""
    document = Document(path)
    file = document.collect(VocabulariesFile)
    if file is None:
        document.check()
        raise AssertionError("a file without faults is parsed")
    _compare(document, file)
    document.check()
    scales = {name: _scales(table) for name, table in file.vocabularies.items() if isinstance(table, ScalesTable)}
    return {
        name: scales[name] if isinstance(table, ScalesTable) else _words(table, scales.get(_PAD))
        for name, table in file.vocabularies.items()
    }


def _compare(document: Document, file: VocabulariesFile) -> None:
    """The faults that more than one value of the file make."""
    if tuple(file.columns) != EMOTIONS:
        document.fault(("columns",), f"[{', '.join(EMOTIONS)}]", str(file.columns))
    pad = file.vocabularies.get(_PAD)
    for name, table in file.vocabularies.items():
        for word, row in table.items.items():
            where = ("vocabularies", name, "items", word)
            if row.source not in file.sources:
                document.fault((*where, "source"), f"one of {', '.join(file.sources)}", repr(row.source))
            if not isinstance(row, WordRow):
                continue
            for emotion in row.shows or ():
                if emotion not in EMOTIONS:
                    document.fault((*where, "shows"), f"some of {', '.join(EMOTIONS)}", repr(emotion))
            if row.pad and not (isinstance(pad, ScalesTable) and len(pad.items) == len(row.pad)):
                document.fault((*where, "pad"), f"a vocabulary {_PAD} with a scale for each number", "none")


def _scales(table: ScalesTable) -> Scales:
    rows = table.items.values()
    bipolar = np.array([row.scale == "bipolar" for row in rows])
    return Scales(table.type, tuple(table.items), bipolar, np.array([row.six for row in rows]))


def _words(table: WordsTable, pad: Scales | None) -> Words:
    shown: dict[str, Mixture] = {}
    for word, row in table.items.items():
        shown[word] = row.shows or {}
        if row.pad is not None and pad is not None:
            (weights,) = mixtures(np.array([row.pad]), pad.six)
            shown[word] = {emotion: round(float(w), 3) for emotion, w in zip(EMOTIONS, weights, strict=True) if w > 0.0}
    return Words(table.type, shown)


@cache
def published() -> dict[str, Vocabulary]:
    """The vocabularies that come with agentface, by the name after the # of their address; read once."""
    return load_vocabularies(rules_file("vocabularies.yaml"))


def mixture_of(word: str, kind: str = "category") -> Mixture | None:
    """What a word shows that no published vocabulary need have; None for one that says nothing to the face.

    The six, their other words and ``neutral`` first, of categories; then the first published vocabulary that has it.
    """
    plain = word.lower()
    emotion = ALIASES.get(plain, plain)
    if kind == "category" and emotion in (*EMOTIONS, NEUTRAL):
        return {emotion: 1.0}
    for vocabulary in published().values():
        if vocabulary.type == kind and isinstance(vocabulary, Words) and plain in vocabulary.mixtures:
            return vocabulary.mixtures[plain]
    return None


def scales_with(word: str, kind: str) -> Scales | None:
    """The first published vocabulary of dimensions or appraisals that has a scale of this name."""
    for vocabulary in published().values():
        if vocabulary.type == kind and isinstance(vocabulary, Scales) and word in vocabulary.names:
            return vocabulary
    return None
