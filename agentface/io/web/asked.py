"""What can be asked of a face in JSON: the requests of OSC, their arguments in OSC's order or by name."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import AgentFaceError, InvalidValueError, UnknownNameError
from agentface.io.bml.reader import read_bml
from agentface.io.osc.addresses import PREFIX, Addresses
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

Schema = dict[str, Any]
"""A value, as JSON Schema describes it."""


@dataclass(frozen=True, slots=True)
class RequestKind:
    """A kind of request.

    Attributes:
        summary: what it does.
        make: makes it of the values by name; raises UnknownNameError or InvalidValueError.
        fields: the values, as JSON Schema has them.
        needed: the names of those that cannot be left out.
    """

    summary: str
    make: Callable[..., Request]
    fields: Mapping[str, Schema]
    needed: tuple[str, ...] = ()


_OSC = Addresses()


def request_of(name: str, told: Any) -> Request | None:
    """The request ``name`` with what it is told: a list of arguments as OSC has them, or an object; None asks nothing.

    Raises UnknownNameError for a name that is none, InvalidValueError for what cannot be meant.
    """
    asked = ASKED.get(name) if isinstance(name, str) else None
    if asked is None:
        raise UnknownNameError("request", name, tuple(ASKED))
    try:
        if isinstance(told, list):
            return _OSC.read(f"{PREFIX}{name}", told)
        return asked.make(**_checked(asked, {} if told is None else told))
    except AgentFaceError:
        raise
    except (TypeError, ValueError, OverflowError, RecursionError) as error:
        got = f"{type(error).__name__}: {error}"[:200]
        raise InvalidValueError(name, f"an object of {', '.join(asked.fields) or 'nothing'}", got) from error


def _checked(asked: RequestKind, told: Any) -> dict[str, Any]:
    if not isinstance(told, dict):
        raise InvalidValueError("body", "an object, or a list of OSC's arguments", type(told).__name__)
    for name in told:
        if name not in asked.fields:
            raise UnknownNameError("value", name, tuple(asked.fields))
    missing = [name for name in asked.needed if name not in told]
    if missing:
        raise InvalidValueError(missing[0], "a value", "none", f"give {' and '.join(asked.needed)}")
    return told


def _number(description: str, low: float | None = None, high: float | None = None) -> Schema:
    limits = {name: limit for name, limit in (("minimum", low), ("maximum", high)) if limit is not None}
    return {"type": "number", "description": description, **limits}


def _text(description: str, *known: str) -> Schema:
    return {"type": "string", "description": description, **({"enum": list(known)} if known else {})}


def _flag(description: str) -> Schema:
    return {"type": "boolean", "description": description}


def _list(description: str, items: Schema) -> Schema:
    return {"type": "array", "description": description, "items": items}


def _levels(description: str) -> Schema:
    return {"type": "object", "description": description, "additionalProperties": {"type": "number"}}


_FADE = _number("seconds until it is reached", 0.0)
_HOLD: Schema = {
    "description": "seconds until the face goes back to the mood, or own for as long as that emotion lasts",
    "anyOf": [{"type": "number", "minimum": 0.0}, {"type": "string", "enum": ["own"]}],
}
_EMOTION = _text(f"{', '.join(EMOTIONS)}, an alias such as joy, or neutral")
_SHARE = _number("how much", 0.0, 1.0)


def _mixed(emotions: Any, fade: float | None = None, hold: Any = None) -> Request:
    return SetEmotions(_state(emotions), fade, hold)


def _mood(emotions: Any = None, fade: float | None = None) -> Request:
    return SetMood(_state({} if emotions is None else emotions), fade)


def _state(emotions: Any) -> EmotionState:
    if not isinstance(emotions, dict):
        raise InvalidValueError("emotions", "an object of intensities 0..1 by name", type(emotions).__name__)
    return EmotionState.of(emotions)


def _arkit(weights: Any, **more: Any) -> Request:
    if not isinstance(weights, dict):
        raise InvalidValueError("weights", "an object of weights 0..1 by ARKit's names", type(weights).__name__)
    return SetArkit(tuple(weights.items()), **more)


def _faps(faps: Any, **more: Any) -> Request:
    if not isinstance(faps, dict):
        raise InvalidValueError("faps", "an object of values by number", type(faps).__name__)
    return SetFaps(tuple((int(number), value) for number, value in faps.items()), **more)


def _bml(bml: Any) -> Request:
    if not isinstance(bml, str):
        raise InvalidValueError("bml", "a block of BML as text", type(bml).__name__)
    return PlayBlock(read_bml(bml, "bml"))


ASKED: dict[str, RequestKind] = {
    "emotion": RequestKind(
        "Show an emotion beside those that are shown.",
        SetEmotion,
        {"emotion": _EMOTION, "intensity": _SHARE, "fade": _FADE, "hold": _HOLD},
        ("emotion", "intensity"),
    ),
    "emotions": RequestKind(
        "Show exactly these emotions.",
        _mixed,
        {"emotions": _levels("intensities 0..1 by name"), "fade": _FADE, "hold": _HOLD},
        ("emotions",),
    ),
    "mood": RequestKind(
        "Have a mood, to which brief emotions return; none without emotions.",
        _mood,
        {"emotions": _levels("intensities 0..1 by name"), "fade": _FADE},
    ),
    "neutral": RequestKind("Let go of everything but the mood.", Neutral, {"fade": _FADE}),
    "say": RequestKind(
        "Say a text; emotions in brackets, as in [joy] Hello, are shown at their words.",
        Say,
        {
            "text": _text("what is said"),
            "voice": _text("the name of a voice"),
            "language": _text("its English name, or its code"),
            "rate": _number("how fast", 0.5, 2.0),
            "interrupt": _flag("in place of what is said now"),
        },
        ("text",),
    ),
    "hush": RequestKind("Say no more.", Hush, {}),
    "state": RequestKind(
        "Live for something; null as by itself: speaking while the face speaks, else idle.",
        SetState,
        {"state": {"description": "idle, listening, thinking or speaking", "type": ["string", "null"]}},
        ("state",),
    ),
    "liveliness": RequestKind(
        "Live between messages: 0, perfectly still, to 1.",
        SetLiveliness,
        {"liveliness": _SHARE, "fade": _FADE},
        ("liveliness",),
    ),
    "gaze": RequestKind(
        "Look far away.",
        SetGaze,
        {
            "yaw_deg": _number("to the person's left", -50.0, 50.0),
            "pitch_deg": _number("up", -40.0, 40.0),
            "fade": _FADE,
        },
        ("yaw_deg", "pitch_deg"),
    ),
    "look_at": RequestKind(
        "Look at a point in front of the face, in metres of the head's axes.",
        LookAt,
        {
            "x": _number("to the person's left"),
            "y": _number("up"),
            "z": _number("forward"),
            "fade": _FADE,
        },
        ("x", "y", "z"),
    ),
    "head": RequestKind(
        "Turn the head.",
        SetHead,
        {
            "yaw_deg": _number("to its left", -80.0, 80.0),
            "pitch_deg": _number("up", -60.0, 60.0),
            "roll_deg": _number("tilted to its left", -50.0, 50.0),
            "fade": _FADE,
        },
        ("yaw_deg", "pitch_deg"),
    ),
    "blink": RequestKind("Blink once.", Blink, {}),
    "gesture": RequestKind(
        "Nod, shake the head, raise the brows, ...",
        Gesture,
        {"name": _text("of rules/gestures.yaml"), "strength": _SHARE, "length": _number("seconds", 0.0)},
        ("name",),
    ),
    "viseme": RequestKind(
        "Show one viseme.",
        ShowViseme,
        {"name": _text("of rules/visemes.yaml"), "weight": _SHARE, "duration": _number("seconds", 0.0)},
        ("name", "weight"),
    ),
    "visemes": RequestKind(
        "Move the mouth as for sounds.",
        Speak.of,
        {
            "phones": _list("triples of name, start and end in seconds", {"type": "array"}),
            "start": _number("seconds from now", 0.0),
            "rate": _number("how fast", 0.25, 4.0),
            "loudness": _number("1 is usual", 0.0, 3.0),
            "interrupt": _flag("in place of what is said now"),
            "live": _flag("more will come"),
            "alphabet": _text("of rules/phones.yaml"),
        },
        ("phones",),
    ),
    "muscle": RequestKind(
        "Hold a muscle, on both sides where its name has none; null releases it.",
        SetMuscle,
        {"name": _text("a muscle"), "contraction": {"description": "0..1", "type": ["number", "null"]}, "fade": _FADE},
        ("name", "contraction"),
    ),
    "parameter": RequestKind(
        "Set any parameter; null releases it.",
        SetParameter,
        {
            "name": _text("a parameter; _deg after an angle's name for degrees"),
            "value": {"description": "in its unit", "type": ["number", "null"]},
            "fade": _FADE,
        },
        ("name", "value"),
    ),
    "au": RequestKind(
        "Show an action unit of FACS.",
        SetActionUnit,
        {
            "number": {"description": "of the unit", "type": "integer"},
            "intensity": {"description": "0..1, or a letter A to E", "type": ["number", "string"]},
            "side": _text("left or right; both when left out", "left", "right"),
            "fade": _FADE,
        },
        ("number", "intensity"),
    ),
    "arkit": RequestKind(
        "Show some of ARKit's 52 weights.",
        _arkit,
        {"weights": _levels("0..1 by ARKit's names"), "fade": _FADE},
        ("weights",),
    ),
    "fap": RequestKind(
        "Show one low-level FAP of MPEG-4.",
        SetFap,
        {"number": {"description": "3..68", "type": "integer"}, "value": _number("in FAP units"), "fade": _FADE},
        ("number", "value"),
    ),
    "faps": RequestKind(
        "Show a frame of FAPs.",
        _faps,
        {
            "faps": _levels("values by number 3..68"),
            "viseme": _list("the four fields of FAP 1", {"type": "integer"}),
            "expression": _list("the six fields of FAP 2", {"type": "integer"}),
            "fade": _FADE,
        },
        ("faps",),
    ),
    "bml": RequestKind("Play a block of BML.", _bml, {"bml": _text("the block")}, ("bml",)),
}
"""By the names that OSC has for them, too."""
