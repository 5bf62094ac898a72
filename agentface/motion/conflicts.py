"""``rules/conflicts.yaml``: the rank of each channel."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from pathlib import Path
from typing import Annotated

from pydantic import AfterValidator, Field

from agentface.cache import prepared, stamp_of
from agentface.config import Document, Table
from agentface.errors import UnknownNameError, did_you_mean
from agentface.motion.channel import Rank, parameters_meant
from agentface.parameters import Way
from agentface.resources import rules_file

CHANNELS = (
    *("emotion", "gaze", "head", "life", "gestures"),
    *("action_units", "performance", "faps", "arkit", "blink", "muscles"),
)
"""The face's own channels; a program adds others."""


def _target(key: str) -> str:
    try:
        parameters_meant(key)
    except UnknownNameError as error:
        raise ValueError(f"expected a parameter, a muscle or a group; {error.hint}") from None
    return key


Target = Annotated[str, AfterValidator(_target)]
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


class ConflictsFile(Table):
    """The whole file."""

    channels: dict[str, Row]
    others: Row


class Conflicts:
    """The ranks of the face's own channels by name, and that of every other."""

    def __init__(self, ranks: Mapping[str, Rank], others: Rank) -> None:
        self._ranks, self._others = dict(ranks), others

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
    document.check()
    assert file is not None, "a document without faults is parsed"  # noqa: S101 - for the type checker
    return Conflicts({name: row.rank() for name, row in file.channels.items()}, file.others.rank())


@cache
def default_conflicts() -> Conflicts:
    """The table that comes with agentface, read once."""
    path = rules_file("conflicts.yaml")
    return prepared(stamp_of([path]), "conflicts", lambda: load_conflicts(path))
