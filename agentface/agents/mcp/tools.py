""":class:`FaceTools`: what language models may ask of a face, as functions with types."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field

from agentface.agents.drawing import Drawing
from agentface.agents.mcp.actor import Actor
from agentface.agents.mcp.report import FaceReport
from agentface.conventions import Bytes
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.motion.figures import STATES
from agentface.requests import (
    GAZE_FADE_S,
    Gesture,
    Hush,
    LookAt,
    Neutral,
    Request,
    Say,
    SetEmotion,
    SetEmotions,
    SetGaze,
    SetMood,
    SetState,
)


def _between(low: float, high: float, what: str) -> Any:
    """A number's range, for who reads the schema: the request is what checks it, and says more."""
    return Field(description=f"{what}, {low:g} to {high:g}", json_schema_extra={"minimum": low, "maximum": high})


def _seconds(what: str) -> Any:
    return Field(description=f"seconds {what}", json_schema_extra={"minimum": 0})


_Emotion = Annotated[str, Field(description=f"one of {', '.join(EMOTIONS)}; or neutral, which lets go of all")]
_Emotions = Annotated[dict[str, float], Field(description=f"intensities, 0 to 1, of {', '.join(EMOTIONS)}")]
_Intensity = Annotated[float, _between(0, 1, "how strong")]
_Fade = Annotated[float | None, _seconds("until it is reached; at the emotion's own pace if not given")]
_Hold = Annotated[float | None, _seconds("from then on until the face goes back to its mood; for good if not given")]


class FaceTools:
    """Each asks something of ``actor``'s face and answers what the face is doing then.

    They raise UnknownNameError and InvalidValueError for what cannot be meant, ServerError for a face that has ended.
    """

    def __init__(self, actor: Actor) -> None:
        self._actor = actor

    async def set_emotion(
        self, emotion: _Emotion, intensity: _Intensity = 0.8, fade_s: _Fade = None, hold_s: _Hold = None
    ) -> FaceReport:
        """Show one emotion and leave the others as they are."""
        return await self._asked(SetEmotion(emotion, intensity, fade_s, hold_s))

    async def set_emotions(self, emotions: _Emotions, fade_s: _Fade = None, hold_s: _Hold = None) -> FaceReport:
        """Show exactly this mixture of emotions; those that are not named go to 0."""
        return await self._asked(SetEmotions(EmotionState.of(emotions), fade_s, hold_s))

    async def set_mood(self, emotions: _Emotions) -> FaceReport:
        """Have a mood, to which the face goes back from brief expressions; empty for none."""
        return await self._asked(SetMood(EmotionState.of(emotions)))

    async def neutral(self) -> FaceReport:
        """Let go of everything: emotions (back to the mood), gaze and head."""
        return await self._asked(Neutral())

    async def say(
        self,
        text: Annotated[
            str,
            Field(description="what is said; words in brackets, as in '[joy] Hello', are emotions shown at their word"),
        ],
        language: Annotated[str, Field(description="its English name or its code, such as german or de")] = "en",
        interrupt: Annotated[bool, Field(description="in place of what is said now, not after it")] = False,
        wait: Annotated[bool, Field(description="answer when all is said, not when it has begun")] = False,
    ) -> FaceReport:
        """Say a text with voice and lips, after what is being said already."""
        waits = bool(await self._actor.call(lambda face: face.talker.texts)) and not interrupt
        doing = await self._actor.apply(Say(text, None, language, 1.0, interrupt))
        if doing is not None and wait:
            await self._actor.over(doing)
        elif doing is not None and not waits:
            await self._actor.begun(doing)
        return await self.status()

    async def hush(self) -> FaceReport:
        """Stop speaking, and forget what waits to be said."""
        return await self._asked(Hush())

    async def gesture(
        self,
        name: Annotated[str, Field(description="its name")],
        strength: Annotated[float, _between(0, 1, "how far")] = 1.0,
    ) -> FaceReport:
        """Do a gesture once: nod, shake the head, raise the brows..."""
        return await self._asked(Gesture(name, strength))

    async def set_gaze(
        self,
        yaw_deg: Annotated[float, _between(-50, 50, "degrees to the face's own left")],
        pitch_deg: Annotated[float, _between(-40, 40, "degrees up")] = 0.0,
    ) -> FaceReport:
        """Turn the eyes; 0, 0 is straight ahead, at who looks at the face."""
        return await self._asked(SetGaze(yaw_deg, pitch_deg, GAZE_FADE_S))

    async def look_at(
        self,
        x_m: Annotated[float, Field(description="metres to the face's own left")],
        y_m: Annotated[float, Field(description="metres up")],
        z_m: Annotated[float, Field(description="metres forward, out of the face")],
    ) -> FaceReport:
        """Look at a point in front of the face; the head joins the eyes for what is far aside."""
        return await self._asked(LookAt(x_m, y_m, z_m))

    async def set_state(
        self,
        state: Annotated[
            str | None, Field(description=f"one of {', '.join(STATES)}; null: speaking while it speaks, else idle")
        ],
    ) -> FaceReport:
        """Behave as somebody who is idle, listens, thinks or speaks."""
        return await self._asked(SetState(state))

    async def status(self) -> FaceReport:
        """What the face is doing now."""
        return await self._actor.call(FaceReport.of)

    async def picture(self, camera: str = "front", size: tuple[int, int] = (512, 512)) -> Bytes:
        """The face as it is shown, ``(height, width, 3)`` uint8; raises GraphicsError."""
        return await self._actor.picture(Drawing(size, camera))

    async def _asked(self, request: Request) -> FaceReport:
        await self._actor.apply(request)
        return await self.status()
