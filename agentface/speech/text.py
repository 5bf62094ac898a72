"""Text as it is spoken: without what is only for the eye, sentence by sentence."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from agentface.errors import InvalidValueError

MOST_CHARACTERS = 10_000
LONGEST_SENTENCE = 300
"""Characters; a longer sentence is spoken in parts, so that its first word does not wait for its last."""

_CODE = re.compile(r"```.*?(?:```|\Z)", re.DOTALL)
_LINK = re.compile(r"!?\[([^\[\]\n]{0,200})\]\([^()\s]{0,500}(?: \"[^\"\n]{0,200}\")?\)")
_URL = re.compile(
    r"\b(?:https?|ftp)://(?:[^\s/@]{1,100}@)?(?:www\.)?([^\s/:?#<>()\[\]]{1,100}?)"
    r"(?:[/:?#][^\s<>()\[\]]*?)?(?=[.,;:!?]*(?:[\s<>()\[\]]|\Z))",
    re.IGNORECASE,
)
_HTML = re.compile(r"</?[a-zA-Z][^<>\n]{0,200}>|&(?:nbsp|amp|lt|gt|quot);")
_LINE_MARK = re.compile(r"^[ \t]*(?:#{1,6}|>+|[-*+•]|\d{1,3}[.)])[ \t]+|^[ \t]*(?:[-*_=|: ]{3,})$", re.M)
_EMPHASIS = re.compile(r"[*`~|\\]|(?<!\w)_+|_+(?!\w)|#(?=\W|$)")
_TERMINAL = re.compile(r"\x1b\[[0-9;]*[A-Za-z]")
_PARAGRAPH = "\u2029"
_NAMED = {"&": " and "}
_KEPT_FORMATS = "\u200c\u200d"
"""They tell how the letters beside them join in Persian and in India's scripts."""

_END = re.compile(r"[.!?…]+[\"'”’»)]*(?=\s)|[。！？]+[」』”]*|\n")  # noqa: RUF001 - the full stops of Chinese and Japanese
_ABBREVIATION = re.compile(
    r"\b(?:[A-HJ-Z]|Mr|Mrs|Ms|Dr|Prof|St|Sr|Jr|vs|etc|e\.g|i\.e|cf|approx|Inc|Ltd|usw|bzw|z\.B|Nr|Hr|Fr|Sra)\.$"
)
_PAUSE = re.compile(r"[,;:\u2013\u2014]\s|\s[\u2013\u2014-]\s")


@dataclass(frozen=True, slots=True)
class SpokenSentence:
    """Part of a text that is spoken in one breath, and the place of its first character in that text."""

    text: str
    start: int


def check_text(text: Any) -> str:
    """``text`` if it is one of at most ``MOST_CHARACTERS``; raises InvalidValueError for anything else."""
    if not isinstance(text, str):
        raise InvalidValueError("text", "text", text)
    if len(text) > MOST_CHARACTERS:
        raise InvalidValueError("text", f"at most {MOST_CHARACTERS} characters", len(text), "send it in parts")
    return text


def spoken(text: str) -> str:
    """What of a text is to be heard, in Unicode's composed form; breaks between lines that end a sentence are kept.

    Code between fences, HTML tags, the marks of Markdown, pictograms and control characters are left out; of a link
    stays its text, of an address on the web its host. Words in square brackets are left as they are.
    """
    text = unicodedata.normalize("NFC", _TERMINAL.sub("", text).replace("\r\n", "\n").replace("\r", "\n"))
    text = _URL.sub(r"\1", _LINK.sub(r"\1", _CODE.sub("\n", text)))
    text = _EMPHASIS.sub("", _LINE_MARK.sub("\n", _HTML.sub(" ", text)))
    text = re.sub(r"\n[ \t]*\n\s*", _PARAGRAPH, text)
    text = "".join(_NAMED.get(character, _plain(character)) for character in text)
    text = re.sub(r"[^\S\n]+", " ", text)
    return re.sub(r" ?\n[ \n]*", "\n", text).strip()


def _plain(character: str) -> str:
    if character == _PARAGRAPH:
        return "\n"
    kind = unicodedata.category(character)
    if character.isspace() or kind == "Cc":
        return " "
    if kind in ("So", "Sk", "Me", "Cs", "Co", "Cn") or "\ufe00" <= character <= "\ufe0f":
        return " "
    return "" if kind == "Cf" and character not in _KEPT_FORMATS else character


def sentences(text: str) -> list[SpokenSentence]:
    """The sentences of what :func:`spoken` has made, each with a letter or a digit; none where there is nothing to say.

    A sentence of more than ``LONGEST_SENTENCE`` characters comes in parts, cut at a pause where it has one.
    """
    return [part for start, end in _bounds(text) for part in _parts(text, start, end)]


def _bounds(text: str) -> Iterator[tuple[int, int]]:
    start = 0
    for end in _END.finditer(text):
        following = text[end.end() : end.end() + 8].lstrip()[:1]
        one_dot = end[0] == "."
        if one_dot and (following.islower() or _ABBREVIATION.search(text, max(start, end.end() - 8), end.end())):
            continue
        yield start, end.end()
        start = end.end()
    yield start, len(text)


def _parts(text: str, start: int, end: int) -> Iterator[SpokenSentence]:
    while start < end:
        cut = end if end - start <= LONGEST_SENTENCE else _cut(text, start, start + LONGEST_SENTENCE)
        part = text[start:cut]
        if any(character.isalnum() for character in part):
            yield SpokenSentence(part.strip(), start + len(part) - len(part.lstrip()))
        start = cut


def _cut(text: str, start: int, end: int) -> int:
    pauses = [pause.end() for pause in _PAUSE.finditer(text, start + LONGEST_SENTENCE // 3, end)]
    if pauses:
        return pauses[-1]
    blank = text.rfind(" ", start + 1, end)
    return end if blank < 0 else blank + 1


def nothing_to_say(text: str) -> InvalidValueError:
    """The error for a text of which nothing is spoken."""
    return InvalidValueError("text", "something that can be spoken", text[:40], "write words")
