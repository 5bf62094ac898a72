"""OSC addresses: what each takes, and the request that it makes of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from agentface.emotion.state import EMOTIONS, NEUTRAL, EmotionState, canonical_or_neutral
from agentface.errors import AgentFaceError, InvalidValueError, UnknownNameError
from agentface.requests import (
    Blink,
    LookAt,
    Neutral,
    Request,
    SetEmotion,
    SetEmotions,
    SetGaze,
    SetHead,
    SetMuscle,
    SetParameter,
)

PREFIX = "/agentface/"
STATUS = "status"
Reader: TypeAlias = Callable[[Sequence[Any]], Request | None]
"""Makes the request of a message's arguments; None asks for nothing. Raises UnknownNameError or InvalidValueError."""
_SPECIAL = frozenset(" #*,?[]{}")


class UnknownAddressError(Exception):
    """An address that is not ours."""


class Addresses:
    """The addresses that a face called ``face`` answers to; a program adds its own with :meth:`add`.

    ``/agentface/emotion`` and its like are also known as ``/agentface/<face>/emotion``.
    """

    def __init__(self, face: str) -> None:
        names = (*_READERS, STATUS)
        self._ours = {f"{before}{name}": name for before in (PREFIX, f"{PREFIX}{face}/") for name in names}
        self._readers: dict[str, Reader] = {}

    def add(self, address: str, reader: Reader) -> None:
        """Have ``reader`` make the requests of the messages to ``address``, such as ``/avatar/breath``.

        A reader that raises has its message refused and answered as those of our own addresses are. Raises
        InvalidValueError for what is no address, and for one that is taken.
        """
        parts = address.split("/") if isinstance(address, str) else []
        plain = all(part and part.isascii() and part.isprintable() and not _SPECIAL & set(part) for part in parts[1:])
        if len(parts) < 2 or parts[0] or not plain:
            raise InvalidValueError("address", "one like /avatar/breath, in ASCII without #*,?[]{} and blanks", address)
        if address in self._ours or address in self._readers:
            raise InvalidValueError("address", "one that is not taken", address, "remove it first, or choose another")
        self._readers[address] = reader

    def remove(self, address: str) -> None:
        """Take away what a program added; raises UnknownNameError."""
        if self._readers.pop(address, None) is None:
            raise UnknownNameError("added address", address, tuple(self._readers))

    def is_status(self, address: str) -> bool:
        """Whether it asks for the status."""
        return self._ours.get(address) == STATUS

    def read(self, address: str, arguments: Sequence[Any]) -> Request | None:
        """The request that a message makes; raises UnknownAddressError, UnknownNameError or InvalidValueError."""
        if address in self._ours:
            return _READERS[self._ours[address]](arguments)
        if address not in self._readers:
            raise UnknownAddressError(address)
        try:
            return self._readers[address](arguments)
        except AgentFaceError:
            raise
        except Exception as error:  # a message must not end a server, whatever a program's reader thinks of it
            expected = "arguments that the program can read"
            raise InvalidValueError("arguments", expected, f"{type(error).__name__}: {error}") from error


def reason_and_hint(error: AgentFaceError) -> tuple[str, str]:
    """An error as the answer gives it: what is wrong, and what to do."""
    if isinstance(error, UnknownNameError):
        return f"expected the name of one {error.kind}, got {error.got!r}"[:200], error.hint
    if isinstance(error, InvalidValueError):
        return f"{error.where}: expected {error.expected}, got {error.got!r}"[:200], error.hint
    return str(error)[:200], ""


def _count(arguments: Sequence[Any], form: str, least: int, most: int) -> None:
    if not least <= len(arguments) <= most:
        raise InvalidValueError("arguments", form, len(arguments), f"send {form}")


def _emotion(arguments: Sequence[Any]) -> Request:
    _count(arguments, "name intensity [fade_s [hold_s]]", 2, 4)
    return SetEmotion(*arguments)


def _emotions(arguments: Sequence[Any]) -> Request:
    form = "pairs of name and intensity"
    if not arguments or len(arguments) % 2 or len(arguments) > 2 * len((*EMOTIONS, NEUTRAL)):
        raise InvalidValueError("arguments", f"one to {len(EMOTIONS) + 1} {form}", len(arguments), f"send {form}")
    names = [canonical_or_neutral(name) for name in arguments[::2]]
    if len(set(names)) < len(names):
        raise InvalidValueError("emotions", "each emotion once", " ".join(names))
    return SetEmotions(EmotionState.of(dict(zip(names, arguments[1::2], strict=True))))


def _neutral(arguments: Sequence[Any]) -> Request:
    _count(arguments, "[fade_s]", 0, 1)
    return Neutral(*arguments)


def _muscle(arguments: Sequence[Any]) -> Request:
    _count(arguments, "name contraction", 2, 2)
    return SetMuscle(*_named(arguments))


def _parameter(arguments: Sequence[Any]) -> Request:
    _count(arguments, "name value", 2, 2)
    return SetParameter(*_named(arguments))


def _gaze(arguments: Sequence[Any]) -> Request:
    _count(arguments, "yaw_deg pitch_deg [duration_s]", 2, 3)
    return SetGaze(*arguments)


def _look_at(arguments: Sequence[Any]) -> Request:
    _count(arguments, "x y z [duration_s]", 3, 4)
    return LookAt(*arguments)


def _head(arguments: Sequence[Any]) -> Request:
    _count(arguments, "yaw_deg pitch_deg roll_deg", 3, 3)
    return SetHead(*arguments)


def _blink(arguments: Sequence[Any]) -> Request:
    _count(arguments, "no arguments", 0, 0)
    return Blink()


def _named(arguments: Sequence[Any]) -> tuple[str, float]:
    """Name and value; OSC's nil is no number, although None releases a muscle elsewhere."""
    name, value = arguments
    if value is None:
        raise InvalidValueError(str(name), "a number", value)
    return name, value


_READERS: dict[str, Callable[[Sequence[Any]], Request]] = {
    "emotion": _emotion,
    "emotions": _emotions,
    "neutral": _neutral,
    "muscle": _muscle,
    "parameter": _parameter,
    "gaze": _gaze,
    "look_at": _look_at,
    "head": _head,
    "blink": _blink,
}
