"""What can be asked of a face, each kind as one record.

Python, OSC, documents, the panel and the command line all make the same ones.
A request is checked where it is made and means the same for every face; ``Face.apply`` carries it out. Requests are
immutable; they compare, hash and pickle, so that they can be noted and applied again. A program's own kind of request
is a subclass of :class:`Request`.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Protocol

from agentface.arkit.channel import ARKIT_CHANNEL, ArkitChannel
from agentface.conventions import check_duration, check_finite, check_fraction, check_range
from agentface.emotion.state import NEUTRAL, EmotionState, canonical_or_neutral
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.facs.action_units import check_intensity, check_side, check_unit
from agentface.head.arkit import ARKIT_SHAPES
from agentface.motion.performance import Performance
from agentface.motion.stream import STREAM_FADE_S
from agentface.mpeg4.fap_stream import EXPRESSION_FIELDS, VISEME_FIELDS, check_fap, check_fields
from agentface.parameters import PARAMETERS, check_degrees, indices_of, muscle_names, parameter, parameter_names

if TYPE_CHECKING:
    from agentface.head.model import HeadModel
    from agentface.motion.mixer import Mixer

FADE_S = 0.25
GAZE_FADE_S = 0.06
"""A saccade."""
HEAD_FADE_S = 0.4
_DEGREES = "_deg"


class Movable(Protocol):
    """What a request reaches: a face's model and what moves it."""

    @property
    def model(self) -> HeadModel:
        """The head."""

    @property
    def channels(self) -> Mixer:
        """The channels by name."""


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
    def apply(self, face: Movable) -> None:
        """Tell the channels; called by ``Face.apply`` alone. What raises has changed nothing."""

    def _keep(self, **checked: object) -> None:
        for name, value in checked.items():
            object.__setattr__(self, name, value)


@dataclass(frozen=True, slots=True)
class SetEmotion(Request):
    """One emotion, the others left as they are.

    Attributes:
        emotion: one of ``EMOTIONS`` or an alias, of which the emotion is kept. ``neutral`` lets go: every emotion
            that is stronger than 1 minus the intensity goes down to that, at intensity 1 all of them to 0.
        intensity: 0..1.
        fade: seconds until it is reached.
        hold: seconds from then until the emotion goes back to 0, as fast; None for never.
    """

    emotion: str
    intensity: float
    fade: float = FADE_S
    hold: float | None = None

    def __post_init__(self) -> None:
        self._keep(
            emotion=canonical_or_neutral(self.emotion),
            intensity=check_fraction("intensity", self.intensity),
            fade=check_duration("fade", self.fade),
            hold=None if self.hold is None else check_duration("hold", self.hold),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each emotion by itself."""
        return type(self).__name__, self.emotion

    def apply(self, face: Movable) -> None:
        """Tell the emotion channel."""
        channel = face.channels.emotion
        if self.emotion != NEUTRAL:
            channel.change({self.emotion: self.intensity}, self.fade, self.hold)
            return
        most = 1.0 - self.intensity
        lowered = {emotion: most for emotion, value in channel.target.items() if value > most}
        if lowered:
            channel.change(lowered, self.fade, None)


@dataclass(frozen=True, slots=True)
class SetEmotions(Request):
    """The whole state of emotions.

    Attributes:
        state: all six intensities; also a mapping from names, of which those that are missing are 0.
        fade: seconds until it is reached.
        hold: seconds from then until the face goes back to neutral, as fast; None for never.
    """

    state: EmotionState
    fade: float = FADE_S
    hold: float | None = None

    def __post_init__(self) -> None:
        self._keep(
            state=EmotionState.of(self.state),
            fade=check_duration("fade", self.fade),
            hold=None if self.hold is None else check_duration("hold", self.hold),
        )

    def apply(self, face: Movable) -> None:
        """Tell the emotion channel."""
        face.channels.emotion.change(self.state, self.fade, self.hold)


@dataclass(frozen=True, slots=True)
class Neutral(Request):
    """Let go of everything, within ``fade`` seconds: emotions, muscles, jaw, gaze, head, and whatever else moves it."""

    fade: float = FADE_S

    def __post_init__(self) -> None:
        self._keep(fade=check_duration("fade", self.fade))

    def apply(self, face: Movable) -> None:
        """Tell every channel."""
        face.channels.release(self.fade)


@dataclass(frozen=True, slots=True)
class Play(Request):
    """A performance from its beginning, in place of the one that is played.

    Attributes:
        performance: poses over time; None ends the one that is played.
        fade: seconds until the face has come to it from what it shows; with 0 every frame is hit exactly.
    """

    performance: Performance | None
    fade: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.performance, Performance | None):
            raise InvalidValueError("performance", "a Performance or None", self.performance)
        self._keep(fade=check_duration("fade", self.fade))

    def apply(self, face: Movable) -> None:
        """Tell the performances' channel."""
        if self.performance is None:
            face.channels.performance.release(self.fade)
        else:
            face.channels.performance.play(self.performance, self.fade)


@dataclass(frozen=True, slots=True)
class SetMuscle(Request):
    """Hold a muscle or the jaw, whatever else moves it.

    Attributes:
        name: one of ``muscle_names()``; without its side it means both.
        contraction: 0..1; None to release it.
        fade: seconds.
    """

    name: str
    contraction: float | None
    fade: float = FADE_S

    def __post_init__(self) -> None:
        if self.name not in muscle_names():
            raise UnknownNameError("muscle", self.name, muscle_names())
        self._keep(
            contraction=None if self.contraction is None else check_fraction(self.name, self.contraction),
            fade=check_duration("fade", self.fade),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each muscle by itself."""
        return type(self).__name__, self.name

    def apply(self, face: Movable) -> None:
        """Tell the muscles' channel."""
        if self.contraction is None:
            face.channels.muscles.release(self.fade, self.name)
        else:
            face.channels.muscles.set(self.name, self.contraction, self.fade)


@dataclass(frozen=True, slots=True)
class SetParameter(Request):
    """Set any one parameter: a muscle as :class:`SetMuscle` does, an angle of gaze or head beside the others.

    Attributes:
        name: a parameter, a paired one also without its side; an angle also with ``_deg`` at its end.
        value: in the parameter's unit and range, radians for angles, degrees where the name says so;
            None to release it.
        fade: seconds.
    """

    name: str
    value: float | None
    fade: float = FADE_S

    def __post_init__(self) -> None:
        name, value = _check_parameter(self.name, self.value)
        self._keep(name=name, value=value, fade=check_duration("fade", self.fade))

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each parameter by itself."""
        return type(self).__name__, self.name

    def apply(self, face: Movable) -> None:
        """Tell the channel that has it."""
        kind = PARAMETERS[indices_of(self.name)[0]].kind
        if kind in ("gaze", "head"):
            turned = face.channels.gaze if kind == "gaze" else face.channels.head
            turned.turn_one(self.name, 0.0 if self.value is None else self.value, self.fade)
        elif self.value is None:
            face.channels.muscles.release(self.fade, self.name)
        else:
            face.channels.muscles.set(self.name, self.value, self.fade)


@dataclass(frozen=True, slots=True)
class SetActionUnit(Request):
    """One action unit of FACS, beside what the emotions show.

    Attributes:
        number: of ``rules/action_units.yaml``; also text such as ``AU12``.
        intensity: 0..1, or one of FACS' letters A to E.
        side: ``left`` or ``right`` of the person, or None for both; kept as ``l`` and ``r``.
        fade: seconds.
    """

    number: int
    intensity: float
    side: str | None = None
    fade: float = FADE_S

    def __post_init__(self) -> None:
        self._keep(
            number=check_unit(self.number),
            intensity=check_intensity(self.intensity),
            side=check_side(self.side),
            fade=check_duration("fade", self.fade),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each unit by itself, on each side."""
        return type(self).__name__, self.number, self.side

    def apply(self, face: Movable) -> None:
        """Tell the action units' channel."""
        face.channels.action_units.set(self.number, self.intensity, self.side, self.fade)


@dataclass(frozen=True, slots=True)
class SetFap(Request):
    """One low-level FAP of MPEG-4, beside those that are still shown.

    Attributes:
        number: 3..68.
        value: in the FAP's unit.
        fade: seconds.
    """

    number: int
    value: float
    fade: float = STREAM_FADE_S

    def __post_init__(self) -> None:
        number, value = check_fap(self.number, self.value)
        self._keep(number=number, value=value, fade=check_duration("fade", self.fade))

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each FAP by itself."""
        return type(self).__name__, self.number

    def apply(self, face: Movable) -> None:
        """Tell the FAPs' channel."""
        face.channels.faps.change(face.model, {self.number: self.value}, self.fade)


@dataclass(frozen=True, slots=True)
class SetFaps(Request):
    """A whole frame of FAPs: what it does not name is free.

    Attributes:
        faps: pairs of number, 3..68, and value in the FAP's unit; also a mapping.
        viseme: FAP 1: two visemes, blend and definition, or None without it.
        expression: FAP 2: an expression and its intensity twice, ``init_face`` and definition, or None.
        fade: seconds from the frame before.
    """

    faps: tuple[tuple[int, float], ...]
    viseme: tuple[int, ...] | None = None
    expression: tuple[int, ...] | None = None
    fade: float = STREAM_FADE_S

    def __post_init__(self) -> None:
        pairs = self.faps.items() if isinstance(self.faps, Mapping) else self.faps
        self._keep(
            faps=tuple(sorted(dict(check_fap(*pair) for pair in pairs).items())),
            viseme=None if self.viseme is None else check_fields("FAP 1", self.viseme, VISEME_FIELDS),
            expression=None if self.expression is None else check_fields("FAP 2", self.expression, EXPRESSION_FIELDS),
            fade=check_duration("fade", self.fade),
        )

    def apply(self, face: Movable) -> None:
        """Tell the FAPs' channel."""
        face.channels.faps.frame(face.model, dict(self.faps), self.viseme, self.expression, self.fade)


@dataclass(frozen=True, slots=True)
class SetArkit(Request):
    """Some of ARKit's 52 face weights, beside those that are still shown.

    Attributes:
        weights: pairs of name and weight 0..1; also a mapping.
        fade: seconds from the frame before.
    """

    weights: tuple[tuple[str, float], ...]
    fade: float = STREAM_FADE_S

    def __post_init__(self) -> None:
        pairs = tuple(self.weights.items() if isinstance(self.weights, Mapping) else self.weights)
        for name, _ in pairs:
            if name not in ARKIT_SHAPES:
                raise UnknownNameError("ARKit weight", name, ARKIT_SHAPES)
        checked = {name: check_fraction(name, weight) for name, weight in pairs}
        self._keep(weights=tuple(sorted(checked.items())), fade=check_duration("fade", self.fade))

    @property
    def key(self) -> tuple[Hashable, ...]:
        """Each set of weights by itself."""
        return type(self).__name__, *(name for name, _ in self.weights)

    def apply(self, face: Movable) -> None:
        """Tell the weights' channel, which is there from the first of them on."""
        channel = face.channels.get(ARKIT_CHANNEL)
        if not isinstance(channel, ArkitChannel):
            channel = ArkitChannel()
            face.channels[ARKIT_CHANNEL] = channel
        channel.change(face.model, dict(self.weights), self.fade)


@dataclass(frozen=True, slots=True)
class SetGaze(Request):
    """Look far away: ``yaw_deg`` to the person's left (-50..50), ``pitch_deg`` up (-40..40), in ``fade`` seconds."""

    yaw_deg: float
    pitch_deg: float
    fade: float = GAZE_FADE_S

    def __post_init__(self) -> None:
        self._keep(
            yaw_deg=check_degrees("gaze_yaw", self.yaw_deg),
            pitch_deg=check_degrees("gaze_pitch", self.pitch_deg),
            fade=check_duration("fade", self.fade),
        )

    @property
    def key(self) -> tuple[Hashable, ...]:
        """The eyes look at one thing."""
        return ("gaze",)

    def apply(self, face: Movable) -> None:
        """Tell the gaze's channel."""
        face.channels.gaze.turn((math.radians(self.yaw_deg), math.radians(self.pitch_deg), 0.0), self.fade)


@dataclass(frozen=True, slots=True)
class LookAt(Request):
    """Look at a point, each eye exactly.

    Attributes:
        x, y, z: metres in the model's axes, where the head is not turned: to the person's left, up, forward.
        fade: seconds.

    A point too far aside is looked at as far as the eyes turn. Which points are in front of the eyes is the face's to
    say: applied to a face, a point that is not raises InvalidValueError.
    """

    x: float
    y: float
    z: float
    fade: float = GAZE_FADE_S

    def __post_init__(self) -> None:
        axes = {axis: check_finite(f"point {axis}", getattr(self, axis)) for axis in ("x", "y", "z")}
        self._keep(**axes, fade=check_duration("fade", self.fade))

    @classmethod
    def of(cls, point: Sequence[float], fade: float = GAZE_FADE_S) -> LookAt:
        """The request for a point of three coordinates; raises InvalidValueError for anything else."""
        try:
            x, y, z = point
        except (TypeError, ValueError):
            raise InvalidValueError("point", "x, y and z in metres", point) from None
        return cls(x, y, z, fade)

    @property
    def key(self) -> tuple[Hashable, ...]:
        """The eyes look at one thing."""
        return ("gaze",)

    def apply(self, face: Movable) -> None:
        """Tell the gaze's channel."""
        from agentface.deform.eyes.eyeballs import toward

        limits = (parameter(name) for name in ("gaze_yaw", "gaze_pitch", "gaze_vergence"))
        aims = zip(limits, toward(face.model, (self.x, self.y, self.z)), strict=True)
        face.channels.gaze.turn(tuple(min(max(aim, limit.low), limit.high) for limit, aim in aims), self.fade)


@dataclass(frozen=True, slots=True)
class SetHead(Request):
    """Turn the head, in ``fade`` seconds: to its left (-80..80 degrees), up (-60..60), tilted to its left (-50..50)."""

    yaw_deg: float
    pitch_deg: float
    roll_deg: float = 0.0
    fade: float = HEAD_FADE_S

    def __post_init__(self) -> None:
        self._keep(
            yaw_deg=check_degrees("head_yaw", self.yaw_deg),
            pitch_deg=check_degrees("head_pitch", self.pitch_deg),
            roll_deg=check_degrees("head_roll", self.roll_deg),
            fade=check_duration("fade", self.fade),
        )

    def apply(self, face: Movable) -> None:
        """Tell the head's channel."""
        degrees = (self.yaw_deg, self.pitch_deg, self.roll_deg)
        face.channels.head.turn(tuple(math.radians(angle) for angle in degrees), self.fade)


@dataclass(frozen=True, slots=True)
class Blink(Request):
    """Blink once."""

    def apply(self, face: Movable) -> None:
        """Tell the blinks' channel."""
        face.channels.blink.blink()


def _check_parameter(name: Any, value: Any) -> tuple[str, float | None]:
    """The parameter that is meant, and the value in its unit; raises UnknownNameError or InvalidValueError."""
    known = parameter_names()
    if name not in known:
        raise UnknownNameError("parameter", name, known)
    plain = str(name).removesuffix(_DEGREES)
    if value is None:
        return plain, None
    meant = PARAMETERS[indices_of(plain)[0]]
    if plain == name:
        return plain, check_range(plain, value, meant.low, meant.high)
    return plain, min(max(math.radians(check_degrees(plain, value)), meant.low), meant.high)
