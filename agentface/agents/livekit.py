""":class:`FaceVideoGenerator`: a face as the avatar of a LiveKit agent (docs.livekit.io/agents)."""

from __future__ import annotations

from collections.abc import AsyncIterator
from typing import Any

from agentface.agents.pieces import SegmentEnd, SoundPiece, VideoFrame
from agentface.agents.speaker import Speaker
from agentface.errors import InvalidValueError, MissingPackageError
from agentface.speech.timed_words import TimedWord

try:
    from livekit import rtc
    from livekit.agents.types import USERDATA_TIMED_TRANSCRIPT
    from livekit.agents.voice.avatar import AudioSegmentEnd, AvatarOptions, VideoGenerator
except ImportError as error:
    raise MissingPackageError("livekit-agents", "livekit", "its AvatarRunner is what a generator is for") from error


class FaceVideoGenerator(VideoGenerator):  # type: ignore[misc]  # LiveKit is not there where types are checked
    """What ``AvatarRunner`` asks for: sound goes in, pictures of the speaking face and the same sound come out.

    ``AvatarRunner(room, audio_recv=..., video_gen=generator, options=generator.options)``. Words with times that the
    text-to-speech tells move the mouth; else it is moved by ear.

    Args:
        speaker: what speaks, with a drawing; :meth:`aclose` closes it.

    Raises InvalidValueError for one that does not draw.
    """

    def __init__(self, speaker: Speaker) -> None:
        if speaker.drawing is None:
            raise InvalidValueError("speaker", "one with a drawing", "one without")
        self.speaker = speaker
        width, height = speaker.drawing.size
        self.options = AvatarOptions(
            video_width=width,
            video_height=height,
            video_fps=speaker.fps,
            audio_sample_rate=speaker.rate_hz,
            audio_channels=1,
        )

    async def push_audio(self, frame: rtc.AudioFrame | AudioSegmentEnd) -> None:
        """Take the next piece of a sound, or its end; raises InvalidValueError, SpeechError."""
        if isinstance(frame, AudioSegmentEnd):
            self.speaker.end_segment()
            return
        words = [word for word in map(_word, frame.userdata.get(USERDATA_TIMED_TRANSCRIPT, ())) if word is not None]
        if words:
            self.speaker.push_words(words)
        self.speaker.push_sound(bytes(frame.data.cast("B")), frame.sample_rate, frame.num_channels)

    def clear_buffer(self) -> None:
        """Be silent at once."""
        self.speaker.clear()

    async def aclose(self) -> None:
        """Close the speaker."""
        import asyncio

        await asyncio.to_thread(self.speaker.close)

    def __aiter__(self) -> AsyncIterator[rtc.VideoFrame | rtc.AudioFrame | AudioSegmentEnd]:
        """Pictures, sound and the ends of sounds, in time."""
        return self._stream()

    async def _stream(self) -> AsyncIterator[rtc.VideoFrame | rtc.AudioFrame | AudioSegmentEnd]:
        kinds = rtc.VideoBufferType
        async for piece in self.speaker:
            if isinstance(piece, VideoFrame) and piece.image is not None:
                height, width, channels = piece.image.shape
                yield rtc.VideoFrame(width, height, kinds.RGBA if channels == 4 else kinds.RGB24, piece.image.tobytes())
            elif isinstance(piece, SoundPiece):
                sound = piece.samples.astype("<i2").tobytes()
                yield rtc.AudioFrame(sound, piece.rate_hz, 1, len(piece.samples))
            elif isinstance(piece, SegmentEnd) and piece.text is None:
                yield AudioSegmentEnd()


def _word(told: Any) -> TimedWord | None:
    """A word with its time; None for one without."""
    start, end = getattr(told, "start_time", None), getattr(told, "end_time", None)
    if not isinstance(start, int | float) or not str(told).strip():
        return None
    return TimedWord(str(told).strip(), max(0.0, start), end if isinstance(end, int | float) and end >= start else None)
