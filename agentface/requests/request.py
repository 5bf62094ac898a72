""":class:`Request`, what every kind of them is, and what it reaches."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Hashable
from typing import TYPE_CHECKING, Protocol

if TYPE_CHECKING:
    from agentface.bml.block import Block
    from agentface.head.model import HeadModel
    from agentface.motion.doing import Doing
    from agentface.motion.mixer import Mixer
    from agentface.speech.synthesizer import Order

FADE_S = 0.25
"""What an emotion or a muscle takes to come, unless a request says otherwise."""


class Sayer(Protocol):
    """What has texts said."""

    def say(self, text: str, order: Order, *, interrupt: bool = False) -> Doing:
        """Say a text when its turn has come, or, with ``interrupt``, at once."""


class PlaysBlocks(Protocol):
    """What has BML blocks played."""

    def play(self, block: Block) -> Doing:
        """Play a block as its composition says."""


class Movable(Protocol):
    """What a request reaches: a face's model, what moves it, and what speaks for it."""

    @property
    def model(self) -> HeadModel:
        """The head."""

    @property
    def channels(self) -> Mixer:
        """The channels by name."""

    @property
    def talker(self) -> Sayer:
        """What has texts said."""

    @property
    def blocks(self) -> PlaysBlocks:
        """What has BML blocks played."""


class Request(ABC):
    """Something that is asked of a face.

    A subclass is a frozen dataclass of immutable values that checks them when it is made and raises UnknownNameError
    or InvalidValueError.
    """

    __slots__ = ()

    @property
    def key(self) -> tuple[Hashable, ...]:
        """What it is about: of requests with the same key that wait for the same frame, only the newest counts."""
        return (type(self).__name__,)

    @abstractmethod
    def apply(self, face: Movable) -> Doing | None:
        """Tell the channels; called by ``Face.apply`` alone. What raises has changed nothing.

        Returns what goes on now, of a kind that takes its time and has an end.
        """

    def _keep(self, **checked: object) -> None:
        for name, value in checked.items():
            object.__setattr__(self, name, value)
