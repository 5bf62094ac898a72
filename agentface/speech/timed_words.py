"""Words whose times are known, as voices tell them, laid out as phones. English."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import accumulate, pairwise

from agentface.conventions import check_range
from agentface.errors import InvalidValueError
from agentface.speech.phones import LONGEST_S, Phone

Lookup = Callable[[str], Sequence[str]]
"""The phones of a word in small letters, in ARPAbet; none for one that it does not know."""
PHONE_S = 0.085
"""What a phone takes in a word whose end nobody has told."""
_LONGEST_WORD = 80
_VOWELS = tuple("AEIOU")
_VOWEL_SHARE = 1.6
"""How long a vowel is, a consonant being 1."""


@dataclass(frozen=True, slots=True)
class TimedWord:
    """A word and when it is said, in seconds from the beginning of the sound; without an end, until the next one.

    Raises InvalidValueError.
    """

    text: str
    start_s: float
    end_s: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.text, str) or len(self.text) > _LONGEST_WORD:
            raise InvalidValueError("word", f"a text of at most {_LONGEST_WORD} characters", self.text)
        start = check_range(f"start of {self.text!r}", self.start_s, 0.0, LONGEST_S)
        object.__setattr__(self, "start_s", start)
        if self.end_s is not None:
            object.__setattr__(self, "end_s", check_range(f"end of {self.text!r}", self.end_s, start, LONGEST_S))


def phones_of_words(words: Sequence[TimedWord], lookup: Lookup) -> tuple[Phone, ...]:
    """The phones of words in the order of their times; of a word that ``lookup`` does not know there are none."""
    ordered = sorted(words, key=lambda word: word.start_s)
    limits = [*(after.start_s for after in ordered[1:]), LONGEST_S][: len(ordered)]
    found: list[Phone] = []
    for word, limit in zip(ordered, limits, strict=True):
        symbols = [symbol for part in plain_words(word.text) for symbol in lookup(part)]
        usual = word.start_s + PHONE_S * len(symbols)
        end = min(limit, usual if word.end_s is None else word.end_s)
        found += _laid_out(symbols, word.start_s, end)
    return tuple(found)


def plain_words(text: str) -> list[str]:
    """The words of a text in small letters, without marks."""
    return re.findall(r"[^\W_]+(?:'[^\W_]+)*", text.lower().replace("\u2019", "'"))


def _laid_out(symbols: Sequence[str], start_s: float, end_s: float) -> list[Phone]:
    shares = [_VOWEL_SHARE if symbol.upper().startswith(_VOWELS) else 1.0 for symbol in symbols]
    if not shares or end_s <= start_s:
        return []
    length = (end_s - start_s) / sum(shares)
    edges = [start_s + length * part for part in (0.0, *accumulate(shares))]
    return [Phone(symbol, start, end) for symbol, (start, end) in zip(symbols, pairwise(edges), strict=True)]
