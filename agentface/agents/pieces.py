"""What a :class:`~agentface.agents.speaker.Speaker` gives out, in the order of its time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

from agentface.conventions import Bytes
from agentface.deform.geometry import FaceGeometry
from agentface.errors import AgentFaceError
from agentface.parameters import FacePose
from agentface.speech.sound import Samples


@dataclass(frozen=True, slots=True, eq=False)
class VideoFrame:
    """The face at one instant, shown until the next one.

    Attributes:
        time_s: seconds of the face since the first one.
        image: ``(height, width, 3)`` uint8 sRGB, or 4 with straight alpha; None where nothing is drawn.
        pose: every animation parameter.
        geometry: the deformed face, whose arrays are this frame's own; None where it is drawn.
    """

    time_s: float
    image: Bytes | None
    pose: FacePose
    geometry: FaceGeometry | None = None


@dataclass(frozen=True, slots=True, eq=False)
class SoundPiece:
    """What is heard from one instant on, as long as it is; after the frame of that instant.

    Attributes:
        time_s: when it begins, on the same clock as the frames.
        samples: ``(N,)`` int16, one channel.
        rate_hz: samples a second.
    """

    time_s: float
    samples: Samples
    rate_hz: int

    @property
    def duration_s(self) -> float:
        """Seconds."""
        return len(self.samples) / self.rate_hz


@dataclass(frozen=True, slots=True)
class SegmentEnd:
    """A text, or a sound whose end was told, was given out to its end.

    Attributes:
        time_s: when it ends, on the same clock.
        text: what was said; None for a sound.
        error: what went wrong with a text; None where it was said.
    """

    time_s: float
    text: str | None = None
    error: AgentFaceError | None = None


Piece: TypeAlias = VideoFrame | SoundPiece | SegmentEnd
