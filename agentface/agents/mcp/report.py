""":class:`FaceReport`: what a face is doing, as tools answer it."""

from __future__ import annotations

from typing import Any, Self

from pydantic import BaseModel, Field

from agentface.face import Face


class FaceReport(BaseModel):
    """What the face is doing now."""

    face: str = Field(description="the face's name")
    emotion: dict[str, float] = Field(description="the intensities, 0..1, that the six emotions go to")
    shown: dict[str, float] = Field(description="the intensities as they are shown at this moment")
    mood: dict[str, float] = Field(description="the intensities that the emotions go back to")
    state: str = Field(description="what the face is about: idle, listening, thinking or speaking")
    liveliness: float = Field(description="0, perfectly still between messages, to 1")
    gaze_yaw_deg: float = Field(description="where the eyes look: degrees to the face's own left")
    gaze_pitch_deg: float = Field(description="where the eyes look: degrees up")
    speaking: bool = Field(description="whether the mouth speaks")
    texts: list[str] = Field(description="what is being said, and what waits to be said")
    speech_error: str | None = Field(description="what went wrong last with a text; null if nothing has")

    @classmethod
    def of(cls, face: Face) -> Self:
        """That of a face; for the thread that steps it."""
        status: dict[str, Any] = face.status()
        yaw, pitch = status["gaze_deg"]
        error = face.talker.error
        return cls(
            face=status["face"],
            emotion=status["emotion"],
            shown=status["shown"]["emotion"],
            mood=status["mood"],
            state=status["state"],
            liveliness=status["liveliness"],
            gaze_yaw_deg=yaw,
            gaze_pitch_deg=pitch,
            speaking=status["speech"] is not None,
            texts=list(face.talker.texts),
            speech_error=None if error is None else str(error),
        )
