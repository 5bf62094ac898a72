"""Ask for a gesture."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from agentface.conventions import check_fraction, check_range
from agentface.errors import InvalidValueError
from agentface.motion.doing import Doing
from agentface.motion.gestures.table import known_as
from agentface.requests.request import Movable, Request

SHORTEST_S, LONGEST_S = 0.1, 3600.0
"""What a gesture may be told to take."""


@dataclass(frozen=True, slots=True)
class Gesture(Request):
    """Do a gesture once, ``strength`` 0..1 times as far as it stands in the table, in ``length`` seconds if it says so.

    Which gestures there are is the face's to say: applied to a face, another name raises UnknownNameError.
    """

    name: str
    strength: float = 1.0
    length: float | None = None

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise InvalidValueError("gesture", "a name", self.name)
        self._keep(
            name=known_as(self.name),
            strength=check_fraction("strength", self.strength),
            length=None if self.length is None else check_range("length", self.length, SHORTEST_S, LONGEST_S),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each gesture by itself."""
        return type(self).__name__, self.name

    def apply(self, face: Movable) -> Doing:
        """Tell the gestures' channel."""
        return face.channels.gestures.play(self.name, self.strength, length_s=self.length)
