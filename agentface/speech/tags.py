"""Words in brackets as language models write them: ``[joy] Hello, [face:surprise:0.7] you``."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass

_BRACKETS = re.compile(r"\[([^\[\]\n]{0,60})\]")
_FORM = re.compile(r"\s*(?:face\s*:\s*)?([^:]+?)\s*(?::\s*(\d*\.?\d+)\s*)?", re.IGNORECASE)


@dataclass(frozen=True, slots=True)
class Tag:
    """What a word in brackets asks for: an emotion at a place of a text.

    Attributes:
        at: the number of characters before it.
        name: what is to be shown.
        level: 0..1; None where the tag does not say it.
    """

    at: int
    name: str
    level: float | None = None


@dataclass(frozen=True, slots=True)
class Tagged:
    """A text without its tags: what they ask for, in their order, and those that nobody knows, as they stood there."""

    text: str
    tags: tuple[Tag, ...]
    unknown: tuple[str, ...]


def split_tags(text: str, known: Callable[[str], str | None]) -> Tagged:
    """Take the tags out of a text.

    ``[NAME]``, ``[NAME:V]``, ``[face:NAME]`` and ``[face:NAME:V]`` with V in 0..1 are tags, and so is whatever else
    stands in brackets, up to 60 characters. ``known`` gives the emotion that a name means, or None.
    """
    plain, place = "", 0
    tags: list[Tag] = []
    unknown: list[str] = []
    for found in _BRACKETS.finditer(text):
        plain = _joined(plain, text[place : found.start()])
        place = found.end()
        tag = _tag(found[1], len(plain), known)
        if tag is None:
            unknown.append(found[0])
        else:
            tags.append(tag)
    plain = _joined(plain, text[place:])
    return Tagged(re.sub(r"[\[\]]", " ", plain), tuple(tags), tuple(unknown))


def _joined(before: str, after: str) -> str:
    """Without the second of two blanks between which a tag stood."""
    return before + (after[1:] if after[:1] == " " and before[-1:] in ("", " ", "\n") else after)


def _tag(inside: str, at: int, known: Callable[[str], str | None]) -> Tag | None:
    form = _FORM.fullmatch(inside)
    if form is None:
        return None
    name, level = known(form[1]), None if form[2] is None else float(form[2])
    return None if name is None or (level or 0.0) > 1.0 else Tag(at, name, level)
