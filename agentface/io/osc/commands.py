"""OSC messages to commands: what each address takes, checked before anything is changed."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from agentface.conventions import check_duration, check_fraction
from agentface.emotion.state import EMOTIONS, EmotionState, canonical
from agentface.errors import AgentFaceError, InvalidValueError, UnknownNameError
from agentface.face import Face
from agentface.io.osc.codec import Message
from agentface.parameters import check_angle, muscle_names

PREFIX = "/agentface/"
STATUS = "status"


@dataclass(frozen=True, slots=True)
class Command:
    """What a message asks of a face. Of several with the same ``key`` only the newest counts."""

    key: tuple[str, ...]
    apply: Callable[[Face], None]


class UnknownAddressError(Exception):
    """An address that is not ours."""


def name_of(address: str, face: str) -> str:
    """``emotion`` of ``/agentface/emotion`` or ``/agentface/<face>/emotion``; raises UnknownAddressError."""
    if not address.startswith(PREFIX):
        raise UnknownAddressError(address)
    name = address.removeprefix(PREFIX).removeprefix(f"{face}/")
    if name != STATUS and name not in _READERS:
        raise UnknownAddressError(address)
    return name


def read_command(name: str, message: Message) -> Command:
    """The checked command of a message; raises UnknownNameError or InvalidValueError."""
    return _READERS[name](message.arguments)


def reason_and_hint(error: AgentFaceError) -> tuple[str, str]:
    """An error as the answer gives it: what is wrong, and what to do."""
    if isinstance(error, UnknownNameError):
        return f"expected the name of one {error.kind}, got {error.got!r}"[:200], error.hint
    if isinstance(error, InvalidValueError):
        return f"{error.where}: expected {error.expected}, got {error.got!r}"[:200], error.hint
    return str(error), ""


def _count(arguments: Sequence[Any], form: str, least: int, most: int) -> None:
    if not least <= len(arguments) <= most:
        raise InvalidValueError("arguments", form, len(arguments), f"send {form}")


def _emotion(arguments: Sequence[Any]) -> Command:
    _count(arguments, "name intensity [fade_s [hold_s]]", 2, 4)
    emotion, intensity = canonical(arguments[0]), check_fraction("intensity", arguments[1])
    times = dict(zip(("fade", "hold"), _durations(arguments[2:]), strict=False))
    return Command(("emotion", emotion), lambda face: face.set_emotion(emotion, intensity, **times))


def _emotions(arguments: Sequence[Any]) -> Command:
    form = "pairs of name and intensity"
    if not arguments or len(arguments) % 2 or len(arguments) > 2 * len(EMOTIONS):
        raise InvalidValueError("arguments", f"one to {len(EMOTIONS)} {form}", len(arguments), f"send {form}")
    names = [canonical(name) for name in arguments[::2]]
    if len(set(names)) < len(names):
        raise InvalidValueError("emotions", "each emotion once", " ".join(names))
    state = EmotionState.of(dict(zip(names, arguments[1::2], strict=True)))
    return Command(("emotions",), lambda face: face.set_emotion(state))


def _neutral(arguments: Sequence[Any]) -> Command:
    _count(arguments, "[fade_s]", 0, 1)
    fades = _durations(arguments)
    return Command(("neutral",), lambda face: face.neutral(*fades))


def _muscle(arguments: Sequence[Any]) -> Command:
    _count(arguments, "name contraction", 2, 2)
    name = arguments[0]
    if name not in muscle_names():
        raise UnknownNameError("muscle", name, muscle_names())
    contraction = check_fraction(str(name), arguments[1])
    return Command(("muscle", name), lambda face: face.set_muscle(name, contraction))


def _gaze(arguments: Sequence[Any]) -> Command:
    _count(arguments, "yaw_deg pitch_deg [duration_s]", 2, 3)
    yaw, pitch = _checked("gaze", ("yaw", "pitch"), arguments)
    times = dict(zip(("fade",), _durations(arguments[2:], "duration_s"), strict=False))
    return Command(("gaze",), lambda face: face.set_gaze(yaw, pitch, **times))


def _head(arguments: Sequence[Any]) -> Command:
    _count(arguments, "yaw_deg pitch_deg roll_deg", 3, 3)
    angles = _checked("head", ("yaw", "pitch", "roll"), arguments)
    return Command(("head",), lambda face: face.set_head(*angles))


def _blink(arguments: Sequence[Any]) -> Command:
    _count(arguments, "no arguments", 0, 0)
    return Command(("blink",), lambda face: face.blink())


def _durations(values: Sequence[Any], first: str = "fade_s") -> list[float]:
    return [check_duration(where, value) for where, value in zip((first, "hold_s"), values, strict=False)]


def _checked(kind: str, axes: Sequence[str], angles: Sequence[Any]) -> list[float]:
    for axis, angle in zip(axes, angles, strict=False):
        check_angle(f"{kind}_{axis}", angle)
    return [float(angle) for angle in angles[: len(axes)]]


_READERS: dict[str, Callable[[Sequence[Any]], Command]] = {
    "emotion": _emotion,
    "emotions": _emotions,
    "neutral": _neutral,
    "muscle": _muscle,
    "gaze": _gaze,
    "head": _head,
    "blink": _blink,
}
