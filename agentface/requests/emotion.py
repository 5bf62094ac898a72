"""Ask for emotions."""

from __future__ import annotations

from collections.abc import Hashable
from dataclasses import dataclass

from agentface.conventions import check_duration, check_fraction
from agentface.emotion.state import NEUTRAL, EmotionState, canonical_or_neutral
from agentface.requests.request import FADE_S, Movable, Request


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
