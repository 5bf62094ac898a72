"""OSC addresses: what each takes, and the request that it makes of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from agentface.emotion.state import EMOTIONS, NEUTRAL, EmotionState, canonical_or_neutral
from agentface.errors import AgentFaceError, InvalidValueError, UnknownNameError
from agentface.io.bml.reader import read_bml
from agentface.io.osc.pattern import is_pattern, matches
from agentface.mpeg4.fap_stream import EXPRESSION, EXPRESSION_FIELDS, VISEME, VISEME_FIELDS
from agentface.mpeg4.fap_table import FAP_COUNT
from agentface.requests import (
    Blink,
    Gesture,
    Hush,
    LookAt,
    Neutral,
    PlayBlock,
    Request,
    Say,
    SetActionUnit,
    SetArkit,
    SetEmotion,
    SetEmotions,
    SetFap,
    SetFaps,
    SetGaze,
    SetHead,
    SetLiveliness,
    SetMood,
    SetMuscle,
    SetParameter,
    SetState,
    ShowViseme,
    Speak,
)

PREFIX = "/agentface/"
STATUS, ERROR, FEEDBACK = "status", "error", "bml/feedback"
Reader: TypeAlias = Callable[[Sequence[Any]], Request | None]
"""Makes the request of a message's arguments; None asks for nothing. Raises UnknownNameError or InvalidValueError."""
_SPECIAL = frozenset(" #*,?[]{}")
_LONGEST_ID = 64


class Addresses:
    """The addresses that faces answer to; a program adds its own with :meth:`add`.

    ``/agentface/emotion`` and its like are for all of them, ``/agentface/<id>/emotion`` for one.
    """

    def __init__(self, *ids: str) -> None:
        names = (*_READERS, STATUS)
        self._all = ids
        self._ours = {f"{PREFIX}{name}": name for name in names}
        self._one: dict[str, str] = {}
        for known in ids:
            self._ours |= {f"{PREFIX}{known}/{name}": name for name in names}
            self._one |= {f"{PREFIX}{known}/{name}": known for name in names}
        self._readers: dict[str, Reader] = {}

    def add(self, address: str, reader: Reader) -> None:
        """Have ``reader`` make the requests of the messages to ``address``, such as ``/avatar/breath``.

        A reader that raises has its message refused and answered as those of our own addresses are. Raises
        InvalidValueError for what is no address, and for one that is taken.
        """
        parts = address.split("/") if isinstance(address, str) else []
        if len(parts) < 2 or parts[0] or not all(map(_is_plain, parts[1:])):
            raise InvalidValueError("address", "one like /avatar/breath, in ASCII without #*,?[]{} and blanks", address)
        if address in self._ours or address in self._readers:
            raise InvalidValueError("address", "one that is not taken", address, "remove it first, or choose another")
        self._readers[address] = reader

    def remove(self, address: str) -> None:
        """Take away what a program added; raises UnknownNameError."""
        if self._readers.pop(address, None) is None:
            raise UnknownNameError("added address", address, tuple(self._readers))

    def ids(self, address: str) -> tuple[str, ...]:
        """The faces that a message to one of these addresses is for."""
        return (self._one[address],) if address in self._one else self._all

    def for_one(self, address: str, face: str) -> str:
        """The address that reaches only the face with this id where ``address`` reaches all; a program's stays."""
        name = self._ours.get(address)
        return address if name is None else f"{PREFIX}{face}/{name}"

    def is_status(self, address: str) -> bool:
        """Whether it is one of those that ask for the status."""
        return self._ours.get(address) == STATUS

    def meant(self, address: str) -> tuple[str, ...]:
        """The addresses that a message's address stands for: itself, or those that a pattern matches."""
        if not is_pattern(address):
            return (address,) if address in self._ours or address in self._readers else ()
        return tuple(known for known in (*self._ours, *self._readers) if matches(address, known))

    def read(self, address: str, arguments: Sequence[Any]) -> Request | None:
        """The request that a message to one of our addresses makes; raises UnknownNameError or InvalidValueError."""
        if address in self._ours:
            return _READERS[self._ours[address]](arguments)
        try:
            return self._readers[address](arguments)
        except AgentFaceError:
            raise
        except Exception as error:  # a message must not end a server, whatever a program's reader thinks of it
            expected = "arguments that the program can read"
            raise InvalidValueError("arguments", expected, f"{type(error).__name__}: {error}") from error


def check_id(name: object) -> str:
    """An id for a face, as a part of an address; raises InvalidValueError."""
    if not isinstance(name, str) or not _is_plain(name) or "/" in name or len(name) > _LONGEST_ID:
        raise InvalidValueError("id", f"up to {_LONGEST_ID} characters of ASCII without /#*,?[]{{}} and blanks", name)
    if name in _READERS or name in (STATUS, ERROR):
        raise InvalidValueError("id", "one that is not the name of a message", name, "choose another")
    return name


def _is_plain(part: str) -> bool:
    """Whether it may be a part of an address between two slashes."""
    return bool(part) and part.isascii() and part.isprintable() and not _SPECIAL & set(part)


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
    if not arguments:
        raise InvalidValueError("arguments", *_pairs_of_emotions(arguments))
    return SetEmotions(_emotions_named(arguments))


def _mood(arguments: Sequence[Any]) -> Request:
    return SetMood(_emotions_named(arguments))


def _emotions_named(arguments: Sequence[Any]) -> EmotionState:
    if len(arguments) % 2 or len(arguments) > 2 * len((*EMOTIONS, NEUTRAL)):
        raise InvalidValueError("arguments", *_pairs_of_emotions(arguments))
    names = [canonical_or_neutral(name) for name in arguments[::2]]
    if len(set(names)) < len(names):
        raise InvalidValueError("emotions", "each emotion once", " ".join(names))
    return EmotionState.of(dict(zip(names, arguments[1::2], strict=True)))


def _pairs_of_emotions(arguments: Sequence[Any]) -> tuple[str, int, str]:
    form = "pairs of name and intensity"
    return f"one to {len(EMOTIONS) + 1} {form}", len(arguments), f"send {form}"


def _neutral(arguments: Sequence[Any]) -> Request | None:
    _count(arguments, "[fade_s]", 0, 1)
    if arguments and not isinstance(arguments[0], bool) and arguments[0] not in (None, "bang"):
        return Neutral(*arguments)
    return Neutral() if pressed(arguments) else None


def _muscle(arguments: Sequence[Any]) -> Request:
    _count(arguments, "name contraction", 2, 2)
    return SetMuscle(*_named(arguments))


def _parameter(arguments: Sequence[Any]) -> Request:
    _count(arguments, "name value", 2, 2)
    return SetParameter(*_named(arguments))


def _au(arguments: Sequence[Any]) -> Request:
    _count(arguments, "unit intensity [side]", 2, 3)
    return SetActionUnit(*arguments)


def _arkit(arguments: Sequence[Any]) -> Request:
    form = "pairs of name and weight"
    if not arguments or len(arguments) % 2:
        raise InvalidValueError("arguments", form, len(arguments), f"send {form}")
    return SetArkit(tuple(zip(arguments[::2], arguments[1::2], strict=True)))


def _fap(arguments: Sequence[Any]) -> Request:
    _count(arguments, "number value", 2, 2)
    return SetFap(*arguments)


def _faps(arguments: Sequence[Any]) -> Request:
    form = f"{FAP_COUNT} mask integers, and a value for each 1 (4 for FAP 1, 6 for FAP 2)"
    mask = arguments[:FAP_COUNT]
    if len(mask) < FAP_COUNT or any(isinstance(bit, bool) or bit not in (0, 1) for bit in mask):
        raise InvalidValueError("mask", form, len(arguments), f"send {form}")
    fields = {VISEME: len(VISEME_FIELDS), EXPRESSION: len(EXPRESSION_FIELDS)}
    widths = [fields.get(column, 1) for column in range(FAP_COUNT)]
    values = list(arguments[FAP_COUNT:])
    needed = sum(width for width, bit in zip(widths, mask, strict=True) if bit)
    if len(values) != needed:
        raise InvalidValueError("values", f"{needed}, as the mask says", len(values), f"send {form}")
    parts: dict[int, list[Any]] = {}
    for column, (width, bit) in enumerate(zip(widths, mask, strict=True)):
        if bit:
            parts[column], values = values[:width], values[width:]
    viseme, expression = parts.pop(VISEME, None), parts.pop(EXPRESSION, None)
    low = tuple((column + 1, part[0]) for column, part in parts.items())
    return SetFaps(low, viseme, expression)  # type: ignore[arg-type]  # makes tuples of them


def _gaze(arguments: Sequence[Any]) -> Request:
    _count(arguments, "yaw_deg pitch_deg [duration_s]", 2, 3)
    return SetGaze(*arguments)


def _look_at(arguments: Sequence[Any]) -> Request:
    _count(arguments, "x y z [duration_s]", 3, 4)
    return LookAt(*arguments)


def _head(arguments: Sequence[Any]) -> Request:
    _count(arguments, "yaw_deg pitch_deg roll_deg", 3, 3)
    return SetHead(*arguments)


def _viseme(arguments: Sequence[Any]) -> Request:
    _count(arguments, "name weight [duration_s]", 2, 3)
    return ShowViseme(*arguments)


def _visemes(arguments: Sequence[Any]) -> Request:
    form = "triples of name, start and end in seconds from now"
    if not arguments or len(arguments) % 3:
        raise InvalidValueError("arguments", form, len(arguments), f"send {form}")
    rows = [arguments[place : place + 3] for place in range(0, len(arguments), 3)]
    return Speak.of(rows, live=True)


def _hush(arguments: Sequence[Any]) -> Request | None:
    return Hush() if pressed(arguments) else None


def _gesture(arguments: Sequence[Any]) -> Request:
    _count(arguments, "name [strength]", 1, 2)
    return Gesture(*arguments)


def _liveliness(arguments: Sequence[Any]) -> Request:
    _count(arguments, "liveliness", 1, 1)
    return SetLiveliness(*arguments)


def _state(arguments: Sequence[Any]) -> Request:
    _count(arguments, "[state]", 0, 1)
    return SetState(*arguments or (None,))


def _say(arguments: Sequence[Any]) -> Request:
    _count(arguments, "text", 1, 1)
    return Say(*arguments)


def _bml(arguments: Sequence[Any]) -> Request:
    _count(arguments, "a block of BML", 1, 1)
    if not isinstance(arguments[0], str):
        raise InvalidValueError("arguments", "a block of BML as text", type(arguments[0]).__name__)
    return PlayBlock(read_bml(arguments[0], "bml"))


def _blink(arguments: Sequence[Any]) -> Request | None:
    return Blink() if pressed(arguments) else None


def pressed(arguments: Sequence[Any]) -> bool:
    """Whether a message that takes no arguments is meant: buttons send one, 0 or false when they are let go of.

    True for no argument, true, an impulse, nil, ``bang`` and any number but 0. Raises InvalidValueError for others.
    """
    first = arguments[0] if arguments else True
    if len(arguments) > 1 or not (first is None or first == "bang" or isinstance(first, bool) or _is_number(first)):
        raise InvalidValueError("arguments", "no arguments", list(arguments), "send no arguments, or a button's one")
    return first is None or first == "bang" or bool(first)


def _is_number(value: Any) -> bool:
    """Whether it is a finite number."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)


def _named(arguments: Sequence[Any]) -> tuple[str, float]:
    """Name and value; OSC's nil is no number, although None releases a muscle elsewhere."""
    name, value = arguments
    if value is None:
        raise InvalidValueError(str(name), "a number", value)
    return name, value


_READERS: dict[str, Reader] = {
    "emotion": _emotion,
    "emotions": _emotions,
    "mood": _mood,
    "neutral": _neutral,
    "muscle": _muscle,
    "parameter": _parameter,
    "au": _au,
    "arkit": _arkit,
    "fap": _fap,
    "faps": _faps,
    "gaze": _gaze,
    "look_at": _look_at,
    "head": _head,
    "viseme": _viseme,
    "visemes": _visemes,
    "hush": _hush,
    "say": _say,
    "bml": _bml,
    "blink": _blink,
    "gesture": _gesture,
    "liveliness": _liveliness,
    "state": _state,
}
