"""``rules/phones.yaml``: what the mouth shows for a sound, in whichever alphabet it is written."""

from __future__ import annotations

import unicodedata
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import chain, pairwise
from pathlib import Path
from typing import Annotated

from pydantic import Field

from agentface.cache import prepared, stamp_of
from agentface.config import Document, Table
from agentface.errors import UnknownNameError, did_you_mean
from agentface.resources import rules_file
from agentface.speech.visemes import VisemeTable, viseme_table

ALPHABETS = ("visemes", "arpabet", "ipa", "azure", "others")
"""In the order in which they are tried."""
_SHARE = Annotated[float, Field(gt=0, le=1)]
_Mixture = str | dict[str, _SHARE]
_Symbols = list[Annotated[str, Field(min_length=1)]]
_FIRST_OF_TWO = 0.55
_PREFIX = "viseme_"
_MOST_LETTERS = 3
"""A symbol of IPA with more than a triphthong has is a word."""


class PhoneRow(Table):
    """What some sounds show."""

    shows: _Mixture | Annotated[list[_Mixture], Field(min_length=1)]
    dominance: _SHARE = 1.0
    arpabet: _Symbols = Field(default_factory=list)
    ipa: _Symbols = Field(default_factory=list)
    azure: _Symbols = Field(default_factory=list)
    others: _Symbols = Field(default_factory=list)


class PhonesFile(Table):
    """The whole file."""

    phones: list[PhoneRow]


@dataclass(frozen=True, slots=True)
class Part:
    """A mixture of visemes that is shown for a part of a sound.

    Attributes:
        visemes: names and shares, the largest share first.
        start, end: 0..1, from when to when of the sound.
        dominance: 0..1, how much it insists on its shape.
    """

    visemes: tuple[tuple[str, float], ...]
    start: float
    end: float
    dominance: float


Looks = tuple[Part, ...]
"""What the mouth shows during one sound, part after part."""


class PhoneTable:
    """The looks of sounds by alphabet and symbol."""

    def __init__(self, looks: Mapping[str, Mapping[str, Looks]]) -> None:
        self._looks = {name: dict(looks[name]) for name in ALPHABETS}
        self._known: dict[tuple[str, str], Looks | None] = {}

    def looks(self, symbols: Sequence[str], alphabet: str | None = None) -> list[Looks]:
        """What each of ``symbols`` shows, read in one of ``ALPHABETS``; None for the first that knows all of them.

        Where none does, each is read by itself. Raises UnknownNameError.
        """
        if alphabet is not None and alphabet not in ALPHABETS:
            raise UnknownNameError("alphabet", alphabet, ALPHABETS)
        for name in ALPHABETS if alphabet is None else (alphabet,):
            found = [self._in(name, symbol) for symbol in symbols]
            if all(found):
                return [looks for looks in found if looks]
        return [self._anywhere(symbol, ALPHABETS if alphabet is None else (alphabet,)) for symbol in symbols]

    def symbols(self, alphabet: str) -> tuple[str, ...]:
        """The symbols that have a row of their own."""
        return tuple(self._looks[alphabet])

    def _anywhere(self, symbol: str, alphabets: Sequence[str]) -> Looks:
        found = next(filter(None, (self._in(name, symbol) for name in alphabets)), None)
        if found is None:
            raise UnknownNameError("phone", symbol, tuple(chain.from_iterable(self._looks[name] for name in alphabets)))
        return found

    def _in(self, alphabet: str, symbol: str) -> Looks | None:
        key = alphabet, symbol
        if key not in self._known:
            if len(self._known) > _MOST_KEPT:
                self._known.clear()
            plain = symbol.strip()
            silence = self._looks["visemes"]["sil"]
            if plain == "sil" or self._looks["others"].get(plain) == silence:  # silence is written alike everywhere
                self._known[key] = silence
            else:
                self._known[key] = _READERS.get(alphabet, _plain)(plain, self._looks[alphabet])
        return self._known[key]


_MOST_KEPT = 5000
"""So many spellings are remembered: symbols come from outside."""


def load_phones(path: str | Path | None = None, visemes: VisemeTable | None = None) -> PhoneTable:
    """The table at ``path``, or the one that comes with agentface; raises DataError with every fault."""
    known = viseme_table() if visemes is None else visemes
    document = Document(path or rules_file("phones.yaml"))
    file = document.parse(PhonesFile)
    looks: dict[str, dict[str, Looks]] = {name: {} for name in ALPHABETS}
    looks["visemes"] = {name: (Part(((name, 1.0),), 0.0, 1.0, 1.0),) for name in known}
    for number, row in enumerate(file.phones):
        _check_names(document, number, row, known)
        shown = _looks_of(row)
        for name in ALPHABETS[1:]:
            for place, symbol in enumerate(getattr(row, name)):
                if symbol in looks[name]:
                    document.fault(("phones", number, name, place), "each symbol once", symbol)
                looks[name][symbol] = shown
    document.check()
    return PhoneTable(looks)


@cache
def phone_table() -> PhoneTable:
    """The table that comes with agentface, read once."""
    files = [rules_file("phones.yaml"), rules_file("visemes.yaml")]
    return prepared(stamp_of(files), "phones", load_phones)


def _mixtures(row: PhoneRow) -> list[tuple[tuple[str | int, ...], dict[str, float]]]:
    """Each mixture of a row, and where it stands in it."""
    listed = isinstance(row.shows, list)
    mixtures = row.shows if isinstance(row.shows, list) else [row.shows]
    return [
        (("shows", place) if listed else ("shows",), {mixture: 1.0} if isinstance(mixture, str) else mixture)
        for place, mixture in enumerate(mixtures)
    ]


def _check_names(document: Document, number: int, row: PhoneRow, visemes: VisemeTable) -> None:
    for where, mixture in _mixtures(row):
        for name in mixture:
            if name not in visemes:
                hint = did_you_mean(name, tuple(visemes))
                document.fault(("phones", number, *where), "the name of a viseme", repr(name), hint)


def _looks_of(row: PhoneRow) -> Looks:
    mixtures = [mixture for _, mixture in _mixtures(row)]
    return _in_turn(
        [Part(tuple(sorted(m.items(), key=lambda item: -item[1])), 0.0, 1.0, row.dominance) for m in mixtures]
    )


def _in_turn(parts: Sequence[Part]) -> Looks:
    count = len(parts)
    cuts = [0.0, _FIRST_OF_TWO, 1.0] if count == 2 else [number / count for number in range(count + 1)]
    return tuple(Part(part.visemes, *times, part.dominance) for part, times in zip(parts, pairwise(cuts), strict=True))


def _plain(symbol: str, table: Mapping[str, Looks]) -> Looks | None:
    return table.get(symbol)


def _viseme(symbol: str, table: Mapping[str, Looks]) -> Looks | None:
    return table.get(symbol.removeprefix(_PREFIX))


def _arpabet(symbol: str, table: Mapping[str, Looks]) -> Looks | None:
    return table.get(symbol.lower().rstrip("0123456789"))


def _ipa(symbol: str, table: Mapping[str, Looks]) -> Looks | None:
    """As it is written, or without its marks, or letter by letter."""
    if symbol in table:
        return table[symbol]
    bare = "".join(letter for letter in unicodedata.normalize("NFD", symbol) if _is_letter(letter))
    if bare in table:
        return table[bare]
    if not 0 < len(bare) <= _MOST_LETTERS:
        return None
    letters = [table.get(letter) for letter in bare]
    if not all(letters):
        return None
    return _in_turn([part for looks in letters if looks for part in looks])


def _is_letter(character: str) -> bool:
    """Whether it is a letter of its own: neither a diacritic, nor a modifier such as length, nor a sign of stress."""
    return unicodedata.category(character) in ("Ll", "Lo", "Lu")


_READERS: dict[str, Callable[[str, Mapping[str, Looks]], Looks | None]] = {
    "visemes": _viseme,
    "arpabet": _arpabet,
    "ipa": _ipa,
}
