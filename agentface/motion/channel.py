""":class:`Channel`: one source of motion, and :class:`Rank`, its place among the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol

from agentface.conventions import Doubles
from agentface.errors import UnknownNameError
from agentface.parameters import GROUPS, MUSCLES, NAMES, PARAMETERS, Way, indices_of, parameter


class Channel(Protocol):
    """What moves some of the parameters: emotions, muscles set by hand, gaze, a program's own breathing.

    It says what it wants, and how much of that; how this is blended with what the others want is its rank's affair.
    """

    @property
    def names(self) -> Sequence[str]:
        """The parameters that it may move, sides apart, in the order of what it writes; always the same."""

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""

    def write(self, values: Doubles, weights: Doubles) -> bool | None:
        """Put in what it wants now; may be called again without ``advance`` between.

        Args:
            values: ``(len(names),)``, in the parameters' units; keep what was written before.
            weights: ``(len(names),)``, 0, which leaves a parameter to the others, .. 1; likewise, and 1 at first.

        Returns False when it wants nothing now: it is then left out, as with weights of 0.
        """

    def release(self, fade: float) -> None:
        """Let go within ``fade`` seconds: the face is told to become neutral."""


@dataclass(frozen=True, slots=True)
class Rank:
    """Where a channel stands among the others.

    Attributes:
        priority: of two channels, that with the higher one is blended over the other; of equals, the newer one.
        way: how its values are blended over what those below have made; None for each parameter's own.
        priorities: exceptions, by parameter, muscle without its side, or group.
        ways: likewise.
    """

    priority: int
    way: Way | None = None
    priorities: dict[str, int] = field(default_factory=dict)
    ways: dict[str, Way] = field(default_factory=dict)

    def priority_of(self, name: str) -> int:
        """The priority for one parameter."""
        return next((self.priorities[key] for key in _keys(name) if key in self.priorities), self.priority)

    def way_of(self, name: str) -> Way:
        """The way for one parameter."""
        own = self.way or parameter(name).way
        return next((self.ways[key] for key in _keys(name) if key in self.ways), own)


def parameters_meant(key: str) -> tuple[str, ...]:
    """The parameters of a group, a muscle without its side, or one parameter; raises UnknownNameError."""
    if key in GROUPS:
        return tuple(known.name for known in PARAMETERS if known.group == key)
    try:
        return tuple(NAMES[index] for index in indices_of(key))
    except UnknownNameError:
        raise UnknownNameError("parameter, muscle or group", key, (*GROUPS, *MUSCLES, *NAMES)) from None


def _keys(name: str) -> tuple[str, ...]:
    """By what an exception may name a parameter, the closest first."""
    known = parameter(name)
    return known.name, known.name[:-2] if known.partner else known.name, known.group
