""":class:`ExpressionCalls`: what a face shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from agentface.calls.calls import Calls
from agentface.emotion.state import NEUTRAL, EmotionState, canonical_or_neutral
from agentface.errors import InvalidValueError
from agentface.motion.emotion import Hold
from agentface.motion.stream import STREAM_FADE_S
from agentface.requests import (
    FADE_S,
    Neutral,
    SetActionUnit,
    SetArkit,
    SetEmotion,
    SetEmotions,
    SetFaps,
    SetMood,
    SetMuscle,
    SetParameter,
)


class ExpressionCalls(Calls):
    """A face's emotions, and its muscles one by one."""

    def set_emotion(
        self,
        emotion: str | Mapping[str, float],
        intensity: float | None = None,
        *,
        fade: float | None = None,
        hold: Hold = None,
    ) -> None:
        """Show one emotion at ``intensity`` 0..1 beside the others, or, given a mapping, exactly this state.

        The face gets there in ``fade`` seconds, or at each emotion's own pace. With ``hold`` it goes back to the mood
        after so many seconds, or with ``own`` after as many as are that emotion's.
        ``neutral`` lets go of the emotions alone: at an intensity below 1, or in a mapping, it leaves each of them at
        most 1 minus that; by itself it needs no intensity.
        """
        if not isinstance(emotion, Mapping):
            if intensity is None and canonical_or_neutral(emotion) == NEUTRAL:
                intensity = 1.0
            self.apply(SetEmotion(emotion, intensity, fade, hold))  # type: ignore[arg-type]  # refuses None itself
            return
        if intensity is not None:
            raise InvalidValueError("intensity", "none beside a mapping, which has its own", intensity)
        self.apply(SetEmotions(EmotionState.of(emotion), fade, hold))

    def set_mood(self, mood: Mapping[str, float] | None = None, *, fade: float | None = None) -> None:
        """Have a mood, to which brief expressions and ``neutral`` return: a state of emotions, {} or None for none."""
        self.apply(SetMood(EmotionState.of(mood), fade))

    def neutral(self, fade: float = FADE_S) -> None:
        """Let go of everything, emotions (back to the mood), single muscles, jaw, gaze and head."""
        self.apply(Neutral(fade))

    def set_muscle(self, name: str, contraction: float | None, *, fade: float = FADE_S) -> None:
        """Hold a muscle (both sides where ``name`` has none) at 0..1, whatever else moves it; None releases it."""
        self.apply(SetMuscle(name, contraction, fade))

    def set_parameter(self, name: str, value: float | None, *, fade: float = FADE_S) -> None:
        """Set any one parameter in its unit; an angle in radians, or in degrees with ``_deg`` after its name.

        None releases it: a muscle goes back to the emotions, an angle to 0.
        """
        self.apply(SetParameter(name, value, fade))

    def set_action_unit(
        self, number: int, intensity: float | str, *, side: str | None = None, fade: float = FADE_S
    ) -> None:
        """Show an action unit of FACS at 0..1, or at a letter A to E, on both sides, or on ``left`` or ``right``."""
        self.apply(SetActionUnit(number, intensity, side, fade))  # type: ignore[arg-type]  # takes letters, keeps numbers

    def set_faps(
        self,
        faps: Mapping[int, float],
        *,
        viseme: Sequence[int] | None = None,
        expression: Sequence[int] | None = None,
        fade: float = STREAM_FADE_S,
    ) -> None:
        """Show a frame of MPEG-4 FAPs by number 3..68, in their units; what it does not name is left to others.

        ``viseme`` has the four fields of FAP 1, ``expression`` the six of FAP 2. Half a second after the last frame
        the face lets go of it.
        """
        self.apply(SetFaps(faps, viseme, expression, fade))  # type: ignore[arg-type]  # takes what it makes tuples of

    def set_arkit(self, weights: Mapping[str, float], *, fade: float = STREAM_FADE_S) -> None:
        """Show some of ARKit's 52 face weights, 0..1 by name, beside those that are still shown.

        Half a second after the last ones the face lets go of them.
        """
        self.apply(SetArkit(weights, fade))  # type: ignore[arg-type]  # takes what it makes tuples of

    def set_jaw(self, opening: float | None, *, fade: float = FADE_S) -> None:
        """Hold the jaw open at 0..1 of its widest opening; None releases it."""
        self.apply(SetMuscle("jaw_open", opening, fade))
