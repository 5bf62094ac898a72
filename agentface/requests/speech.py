"""Move the mouth as for speech."""

from __future__ import annotations

from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

from agentface.conventions import check_duration, check_fraction, check_range
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.motion.doing import Doing
from agentface.requests.request import Movable, Request
from agentface.speech.alphabets import phone_table
from agentface.speech.phones import LONGEST_S, Phone, phones_of
from agentface.speech.visemes import viseme_table

SLOWEST, FASTEST = 0.25, 4.0
"""Rates of speech."""
LOUDEST = 3.0
_MOST_PHONES = 20_000


@dataclass(frozen=True, slots=True)
class Speak(Request):
    """Say phones.

    Attributes:
        phones: one after the other; :meth:`of` makes them of triples, too.
        start: seconds from now, or from the end of what is said before, to the time 0 of the phones.
        rate: how many times as fast they are said, 0.25..4.
        loudness: 0..3; 1 is a usual voice.
        interrupt: whether what is said and what waits is dropped.
        live: whether more will come: the newest counts from its first phone on, its times from now.
        alphabet: of ``ALPHABETS``; None for the first that knows all phones.
    """

    phones: tuple[Phone, ...]
    start: float = 0.0
    rate: float = 1.0
    loudness: float = 1.0
    interrupt: bool = False
    live: bool = False
    alphabet: str | None = None

    def __post_init__(self) -> None:
        phones = phones_of(self.phones)
        if len(phones) > _MOST_PHONES:
            raise InvalidValueError("phones", f"at most {_MOST_PHONES}", len(phones), "speak sentence by sentence")
        for name in ("interrupt", "live"):
            if not isinstance(getattr(self, name), bool):
                raise InvalidValueError(name, "true or false", getattr(self, name))
        phone_table().looks([phone.symbol for phone in phones], self.alphabet)
        self._keep(
            phones=phones,
            start=check_range("start", self.start, 0.0, LONGEST_S),
            rate=check_range("rate", self.rate, SLOWEST, FASTEST),
            loudness=check_range("loudness", self.loudness, 0.0, LOUDEST),
        )

    @classmethod
    def of(
        cls,
        phones: Iterable[Phone | Sequence[Any]],
        start: float = 0.0,
        rate: float = 1.0,
        loudness: float = 1.0,
        interrupt: bool = False,
        live: bool = False,
        alphabet: str | None = None,
    ) -> Speak:
        """Of phones, or of triples of name, start and end in s."""
        if isinstance(phones, str) or not isinstance(phones, Iterable):
            raise InvalidValueError("phones", "triples of name, start and end", phones)
        return cls(phones_of(phones), start, rate, loudness, interrupt, live, alphabet)

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each by itself: one does not stand for another."""
        return type(self).__name__, self

    def apply(self, face: Movable) -> Doing | None:
        """Tell the channel of speech."""
        return face.channels.speech.speak(
            self.phones,
            start=self.start,
            rate=self.rate,
            loudness=self.loudness,
            interrupt=self.interrupt,
            live=self.live,
            alphabet=self.alphabet,
        )


@dataclass(frozen=True, slots=True)
class Hush(Request):
    """Say no more."""

    def apply(self, face: Movable) -> None:
        """Tell the channel of speech."""
        face.channels.speech.hush()


@dataclass(frozen=True, slots=True)
class TakeBack(Request):
    """Do not say phones that still wait for their turn.

    Attributes:
        speak: what had them said.
    """

    speak: Speak

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each by itself."""
        return type(self).__name__, self.speak

    def apply(self, face: Movable) -> None:
        """Tell the channel of speech."""
        face.channels.speech.take_back(self.speak.phones)


@dataclass(frozen=True, slots=True)
class ShowViseme(Request):
    """Show one viseme beside others.

    Attributes:
        name: as in ``rules/visemes.yaml``.
        weight: 0..1.
        duration: seconds until it goes again; None until it is told to.
    """

    name: str
    weight: float
    duration: float | None = None

    def __post_init__(self) -> None:
        known = tuple(viseme_table())
        name = self.name.removeprefix("viseme_") if isinstance(self.name, str) else self.name
        if name not in known:
            raise UnknownNameError("viseme", self.name, known)
        self._keep(
            name=name,
            weight=check_fraction("weight", self.weight),
            duration=None if self.duration is None else check_duration("duration", self.duration),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each viseme by itself."""
        return type(self).__name__, self.name

    def apply(self, face: Movable) -> None:
        """Tell the channel of speech."""
        face.channels.speech.show(self.name, self.weight, self.duration)
