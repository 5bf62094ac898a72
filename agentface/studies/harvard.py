"""``harvard.yaml``: sentences with the times of their phones, on which speech is measured."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from agentface.config import Table, load
from agentface.speech.phones import Phone


class SentenceRow(Table):
    """Words, and phones each with its end in s."""

    text: str
    phones: str


class HarvardFile(Table):
    """The whole file."""

    sentences: list[SentenceRow]


@dataclass(frozen=True, slots=True)
class Sentence:
    """What is said, and when each phone is, in s."""

    text: str
    phones: tuple[Phone, ...]

    @property
    def duration_s(self) -> float:
        """How long it takes."""
        return self.phones[-1].end_s


@cache
def harvard() -> tuple[Sentence, ...]:
    """The twenty sentences of lists 1 and 2."""
    rows = load(Path(__file__).with_suffix(".yaml"), HarvardFile).sentences
    return tuple(Sentence(row.text, _phones(row.phones.split())) for row in rows)


def _phones(words: list[str]) -> tuple[Phone, ...]:
    ends = [float(end) for end in words[1::2]]
    return tuple(Phone(*each) for each in zip(words[::2], [0.0, *ends[:-1]], ends, strict=True))
