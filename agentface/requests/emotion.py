"""Ask for emotions."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from agentface.conventions import check_duration, check_fraction
from agentface.emotion.state import NEUTRAL, EmotionState, canonical_or_neutral
from agentface.errors import InvalidValueError
from agentface.motion.emotion import Hold
from agentface.requests.request import Movable, Request


@dataclass(frozen=True, slots=True)
class SetEmotion(Request):
    """One emotion, the others left as they are.

    Attributes:
        emotion: one of ``EMOTIONS`` or an alias, of which the emotion is kept. ``neutral`` lets go: every emotion
            that is stronger than 1 minus the intensity, and than the mood, goes down to that, at intensity 1 all of
            them to the mood.
        intensity: 0..1.
        fade: seconds until it is reached; None for the emotion's own pace.
        hold: seconds from then until the emotion goes back to the mood, in the same fade or at its own pace; ``own``
            for as long as its envelope says, None for never.
    """

    emotion: str
    intensity: float
    fade: float | None = None
    hold: Hold = None

    def __post_init__(self) -> None:
        self._keep(
            emotion=canonical_or_neutral(self.emotion),
            intensity=check_fraction("intensity", self.intensity),
            fade=check_fade(self.fade),
            hold=_check_hold(self.hold),
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
        if self.intensity == 1.0:
            channel.release(self.fade)
            return
        most = {emotion: max(1.0 - self.intensity, mood) for emotion, mood in channel.mood.items()}
        lowered = {emotion: most[emotion] for emotion, value in channel.target.items() if value > most[emotion]}
        if lowered:
            channel.change(lowered, self.fade, None)


@dataclass(frozen=True, slots=True)
class SetEmotions(Request):
    """The whole state of emotions.

    Attributes:
        state: all six intensities; also a mapping from names, of which those that are missing are 0.
        fade: seconds until it is reached; None for each emotion's own pace.
        hold: seconds from then until the face goes back to the mood; as for one emotion.
    """

    state: EmotionState
    fade: float | None = None
    hold: Hold = None

    def __post_init__(self) -> None:
        self._keep(
            state=EmotionState.of(self.state),
            fade=check_fade(self.fade),
            hold=_check_hold(self.hold),
        )

    def apply(self, face: Movable) -> None:
        """Tell the emotion channel."""
        face.channels.emotion.change(self.state, self.fade, self.hold)


def check_fade(value: object) -> float | None:
    """Seconds, or None; raises InvalidValueError."""
    return None if value is None else check_duration("fade", value)


def _check_hold(value: object) -> Hold:
    if isinstance(value, str) and value != "own":
        raise InvalidValueError("hold", "a number of seconds, zero or more, or own", value)
    return value if value is None or value == "own" else check_duration("hold", value)
