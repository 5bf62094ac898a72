"""``rules/conflicts.yaml``: the rank of each channel, and the pairs of muscles that look wrong together."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import AfterValidator, Field

from agentface.cache import prepared, stamp_of
from agentface.config import Document, Table
from agentface.errors import UnknownNameError, did_you_mean
from agentface.motion.channel import Rank, parameters_meant
from agentface.motion.pairs import Pairs
from agentface.parameters import GROUPS, MUSCLES, Way, parameter
from agentface.resources import rules_file

CHANNELS = (
    *("emotion", "gaze", "head", "action_units", "performance", "faps", "arkit", "tracker", "speech"),
    *("life", "gestures", "blink", "muscles"),
)
"""The face's own channels; a program adds others."""


def _target(key: str) -> str:
    try:
        parameters_meant(key)
    except UnknownNameError as error:
        raise ValueError(f"expected a parameter, a muscle or a group; {error.hint}") from None
    return key


def _muscle(name: str) -> str:
    if name not in MUSCLES:
        raise ValueError(f"expected a muscle without its side; {did_you_mean(name, MUSCLES)}")
    return name


Target = Annotated[str, AfterValidator(_target)]
_Share = Annotated[float, Field(ge=0, le=1)]
Priority = Annotated[int, Field(ge=0, le=100)]


class Row(Table):
    """The rank of one channel."""

    priority: Priority
    way: Way | None = None
    priorities: dict[Target, Priority] = Field(default_factory=dict)
    ways: dict[Target, Way] = Field(default_factory=dict)

    def rank(self) -> Rank:
        """The same without pydantic."""
        return Rank(self.priority, self.way, dict(self.priorities), dict(self.ways))


class YieldRow(Table):
    """How much of what a muscle does gives way to speech."""

    speaking: _Share = 0.0
    rounding: _Share = 0.0
    closure: _Share = 0.0


class PairRow(Table):
    """Two muscles with their priorities, and why they look wrong together."""

    muscles: Annotated[
        dict[Annotated[str, AfterValidator(_muscle)], Annotated[int, Field(ge=1, le=100)]],
        Field(min_length=2, max_length=2),
    ]
    reason: str


class ConflictsFile(Table):
    """The whole file."""

    channels: dict[str, Row]
    others: Row
    speech_yields: dict[Target, YieldRow]
    speech_rounds: list[Target]
    speech_closes: list[Target]
    pairs: list[PairRow] = Field(default_factory=list)


@dataclass(frozen=True, slots=True)
class SpeechYields:
    """How what the face feels gives way to what it says.

    Attributes:
        shares: 0..1 to speaking, to rounding and to closure, by parameter without side.
        rounds: the parameters without side that make the lips round.
        closes: those that bring them together.
    """

    shares: Mapping[str, tuple[float, float, float]]
    rounds: tuple[str, ...]
    closes: tuple[str, ...]


class Conflicts:
    """The ranks of the face's own channels by name, that of every other, what gives way to speech, and the pairs."""

    def __init__(self, ranks: Mapping[str, Rank], others: Rank, yields: SpeechYields, pairs: Pairs) -> None:
        self._ranks, self._others, self.yields, self.pairs = dict(ranks), others, yields, pairs

    def rank(self, name: str) -> Rank:
        """The rank of the channel called ``name``."""
        return self._ranks.get(name, self._others)


def load_conflicts(path: str | Path) -> Conflicts:
    """The table at ``path``; raises DataError with every fault of it."""
    document = Document(path)
    file = document.collect(ConflictsFile)
    data = document.data.get("channels") if isinstance(document.data, dict) else None
    if isinstance(data, dict):
        for name in data:
            if name not in CHANNELS:
                document.fault(("channels", name), "the name of a channel", repr(name), did_you_mean(name, CHANNELS))
        for name in CHANNELS:
            if name not in data:
                document.fault(("channels", name), "this key", "nothing")
    for place, pair in enumerate(_named(document)):
        if pair and pair in _named(document)[:place]:
            document.fault(("pairs", place), "each pair once", "the pair a second time")
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    ranks = {name: row.rank() for name, row in file.channels.items()}
    return Conflicts(ranks, file.others.rank(), _yields(file), _pairs(file.pairs))


def _yields(file: ConflictsFile) -> SpeechYields:
    """Groups first, so that a muscle's own row counts."""
    groups = [key for key in file.speech_yields if key in GROUPS]
    shares: dict[str, tuple[float, float, float]] = {}
    for key in (*groups, *(key for key in file.speech_yields if key not in GROUPS)):
        row = file.speech_yields[key]
        shares |= dict.fromkeys(_plain(key), (row.speaking, row.rounding, row.closure))
    rounds, closes = (
        tuple(dict.fromkeys(name for key in keys for name in _plain(key)))
        for keys in (file.speech_rounds, file.speech_closes)
    )
    return SpeechYields(shares, rounds, closes)


def _plain(key: str) -> list[str]:
    """The parameters that a target means, without their sides."""
    known = map(parameter, parameters_meant(key))
    return list(dict.fromkeys(each.name[:-2] if each.partner else each.name for each in known))


def _named(document: Document) -> list[set[str]]:
    """The muscles of each pair as they are written; none where they are not."""
    data = document.data.get("pairs") if isinstance(document.data, dict) else None
    rows = [row.get("muscles") if isinstance(row, dict) else None for row in data] if isinstance(data, list) else []
    return [{str(name) for name in row} if isinstance(row, dict) else set() for row in rows]


def _pairs(rows: list[PairRow]) -> Pairs:
    places = np.array([[MUSCLES.index(name) for name in row.muscles] for row in rows], np.int32).reshape(-1, 2)
    priorities = np.array([list(row.muscles.values()) for row in rows], np.float64).reshape(-1, 2)
    return Pairs(places[:, 0].copy(), places[:, 1].copy(), priorities)


@cache
def default_conflicts() -> Conflicts:
    """The table that comes with agentface, read once."""
    path = rules_file("conflicts.yaml")
    return prepared(stamp_of([path]), "conflicts", lambda: load_conflicts(path))
