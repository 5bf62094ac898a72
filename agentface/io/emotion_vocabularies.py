"""The vocabularies of an EmotionML document: those that the W3C publishes, and those that the document declares.

Source: Vocabularies for EmotionML, W3C Note 1 April 2014, section 2, "Vocabularies for emotion categories"; Emotion
Markup Language 1.0, section 2.1.3, "Defining vocabularies".
"""

from __future__ import annotations

import re
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, Field

from agentface.config import Table, load
from agentface.emotion.state import ALIASES, EMOTIONS, NEUTRAL
from agentface.errors import did_you_mean
from agentface.io.markup import Element
from agentface.resources import rules_file

Tell = Callable[[int, str, str, str, str], None]
"""Takes a fault: line, where, expected, got, hint."""

_PUBLISHED = "http://www.w3.org/TR/emotion-voc/xml#"
BIG6 = f"{_PUBLISHED}big6"
INTENSITY = f"{_PUBLISHED}intensity-dimension"
_TYPES = ("category", "dimension", "appraisal", "action-tendency")
_ID = re.compile(r"[^\W\d][\w.-]*")
_NAME = re.compile(r"[\w.:-]+")


def _word(name: str) -> str:
    if not _NAME.fullmatch(name):
        raise ValueError("expected a word without blanks")
    return name


def _once(names: list[str]) -> list[str]:
    if len(set(names)) < len(names):
        raise ValueError("expected each name once")
    return names


Name = Annotated[str, AfterValidator(_word)]


class VocabulariesFile(Table):
    """``rules/vocabularies.yaml``: the names of each published set of categories."""

    categories: dict[Name, Annotated[list[Name], Field(min_length=1), AfterValidator(_once)]]


def load_vocabularies(path: str | Path) -> VocabulariesFile:
    """The file at ``path``; raises DataError with every fault of it."""
    path = Path(path)
    return load(path, VocabulariesFile)


@cache
def published() -> dict[str, tuple[str, ...]]:
    """The sets of categories that come with agentface, read once."""
    file = load_vocabularies(rules_file("vocabularies.yaml"))
    return {name: tuple(names) for name, names in file.categories.items()}


def shown_as(category: str) -> str | None:
    """The emotion, or ``neutral``, that a category's name means; None for one that the face does not show."""
    word = category.lower()
    emotion = ALIASES.get(word, word)
    return emotion if emotion in (*EMOTIONS, NEUTRAL) else None


def is_id(text: str) -> bool:
    """Whether it may identify an element: it begins with a letter or an underscore."""
    return _ID.fullmatch(text) is not None


class Vocabularies:
    """The names of categories by the URI of their set."""

    def __init__(self) -> None:
        self._names = {f"{_PUBLISHED}{name}": names for name, names in published().items()}

    def names(self, uri: str | None) -> tuple[str, ...] | None:
        """The names of a set; None for one that is not known."""
        return self._names.get((uri or "").strip())

    def declare(self, element: Element, items: list[Element], tell: Tell) -> None:
        """Take in a ``<vocabulary>``; what it lacks is told."""
        name, kind = (element.attributes.get(key, "").strip() for key in ("id", "type"))
        if not is_id(name):
            got = repr(name) if name else "none"
            tell(element.line, "vocabulary.id", "an id that begins with a letter", got, "")
        if kind not in _TYPES:
            got = repr(kind) if kind else "nothing"
            tell(element.line, "vocabulary.type", f"one of {', '.join(_TYPES)}", got, did_you_mean(kind, _TYPES))
        if f"#{name}" in self._names:
            tell(element.line, "vocabulary.id", "an id of its own", f"{name!r} again", "")
        if not items:
            tell(element.line, "vocabulary", "at least one <item>", "none", "")
        names: dict[str, None] = {}
        for item in items:
            word = item.attributes.get("name", "").strip()
            if not _NAME.fullmatch(word):
                tell(item.line, "vocabulary.item.name", "a word", repr(word) if word else "nothing", "")
            elif word in names:
                tell(item.line, "vocabulary.item.name", "each name once", f"{word!r} again", "")
            names[word] = None
        self._names[f"#{name}"] = tuple(names) if kind == "category" else ()
