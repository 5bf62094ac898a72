""":class:`FaceProcessor`: a face in a pipeline of Pipecat (pipecat.ai), after its text-to-speech."""

from __future__ import annotations

import asyncio
from collections import deque
from dataclasses import dataclass
from typing import Any

from agentface.agents.pieces import Piece, SegmentEnd, SoundPiece, VideoFrame
from agentface.agents.speaker import Speaker
from agentface.errors import AgentFaceError, MissingPackageError
from agentface.requests import Request, SetState

try:
    from pipecat.frames.frames import (
        CancelFrame,
        DataFrame,
        EndFrame,
        Frame,
        InterruptionFrame,
        LLMFullResponseStartFrame,
        OutputImageRawFrame,
        StartFrame,
        TTSAudioRawFrame,
        TTSStartedFrame,
        TTSStoppedFrame,
        TTSTextFrame,
        UserStartedSpeakingFrame,
        UserStoppedSpeakingFrame,
    )
    from pipecat.processors.frame_processor import FrameDirection, FrameProcessor
except ImportError as error:
    raise MissingPackageError("pipecat-ai", "pipecat", "its pipelines are what a FaceProcessor is for") from error

_STATES: dict[type, str | None] = {
    UserStartedSpeakingFrame: "listening",
    UserStoppedSpeakingFrame: "thinking",
    LLMFullResponseStartFrame: "thinking",
    TTSStartedFrame: None,
}
_NANOSECONDS = 1e9


@dataclass
class FaceRequestFrame(DataFrame):  # type: ignore[misc]  # Pipecat is not there where types are checked
    """Asks something of the face, such as ``SetEmotion("happiness", 0.8)``, where it is met in the pipeline."""

    request: Request


class FaceProcessor(FrameProcessor):  # type: ignore[misc]
    """Takes the sound of text-to-speech, and pushes pictures of the speaking face and the same sound, in time.

    Place it after the text-to-speech service and before the transport, which has ``video_out_enabled`` and the size of
    the speaker's pictures. An interruption silences the face at once, ``TTSStoppedFrame`` waits until all is heard, and
    so does ``EndFrame``. Words with times, of services that tell them, move the mouth; else it is moved by ear.

    Args:
        speaker: what speaks; it is closed with the pipeline.
        states: whether the face listens, thinks and speaks as the frames say.
        named: as any processor of Pipecat.
    """

    def __init__(self, speaker: Speaker, *, states: bool = True, **named: Any) -> None:
        super().__init__(**named)
        self.speaker = speaker
        self._states = states
        self._task: asyncio.Task[None] | None = None
        self._held: deque[Frame] = deque()
        self._context: str | None = None
        self._sounds = False
        self._going = 0
        self._sound_began = self._last_word = 0
        self._still = asyncio.Event()

    async def process_frame(self, frame: Frame, direction: FrameDirection) -> None:
        """Take one frame."""
        await super().process_frame(frame, direction)
        if isinstance(frame, TTSAudioRawFrame):
            await self._take_sound(frame)
            return
        if self._states and type(frame) in _STATES:
            self.speaker.face.ask(SetState(_STATES[type(frame)]))
        await self._take(frame)
        if isinstance(frame, TTSStartedFrame | TTSStoppedFrame) and (self._held or self._going):
            self._held.append(frame)
        else:
            await self._pass(frame, direction)
        if isinstance(frame, StartFrame):
            self._task = self.create_task(self._show())

    async def _take(self, frame: Frame) -> None:
        """Do what a frame means for the face before it goes on."""
        if isinstance(frame, FaceRequestFrame):
            self.speaker.face.ask(frame.request)
        elif isinstance(frame, TTSTextFrame):
            self._take_word(frame)
        elif isinstance(frame, InterruptionFrame):
            self._clear()
        elif isinstance(frame, TTSStoppedFrame):
            self._end()
        elif isinstance(frame, EndFrame):
            self._end()
            await self._drained()
            await self._stop()
        elif isinstance(frame, CancelFrame):
            await self._stop()

    async def cleanup(self) -> None:
        """End with the pipeline."""
        await super().cleanup()
        await self._stop()
        await asyncio.to_thread(self.speaker.close)

    async def _take_sound(self, frame: TTSAudioRawFrame) -> None:
        if not self._sounds:
            self._sounds = True
            self._sound_began = max(self._last_word, self.get_clock().get_time())
        try:
            self.speaker.push_sound(frame.audio, frame.sample_rate, frame.num_channels)
        except AgentFaceError as error:
            await self.push_error(error_msg=str(error), exception=error)

    def _take_word(self, frame: TTSTextFrame) -> None:
        """A word with its time, which services count from the first sound of what they say, on the pipeline's clock."""
        if frame.pts and self._sounds and len(frame.text.split()) == 1:
            self._last_word = frame.pts
            self.speaker.push_words([(frame.text.strip(), max(0, frame.pts - self._sound_began) / _NANOSECONDS)])

    def _end(self) -> None:
        self._going += self._sounds
        self._sounds = False
        self.speaker.end_segment()

    def _clear(self) -> None:
        self._sounds, self._going = False, 0
        self._held.clear()
        self.speaker.clear()
        self._still.set()

    async def _drained(self) -> None:
        """Wait until all that was pushed is heard."""
        while self._going and self._task is not None and not self._task.done():
            self._still.clear()
            await self._still.wait()

    async def _stop(self) -> None:
        task, self._task = self._task, None
        if task is not None:
            await self.cancel_task(task)

    async def _show(self) -> None:
        try:
            async for piece in self.speaker:
                await self._give(piece)
        except AgentFaceError as error:
            await self.push_error(error_msg=str(error), exception=error)
        finally:
            self._still.set()

    async def _give(self, piece: Piece) -> None:
        if isinstance(piece, VideoFrame) and piece.image is not None:
            height, width, channels = piece.image.shape
            kind = "RGBA" if channels == 4 else "RGB"
            image = OutputImageRawFrame(image=piece.image.tobytes(), size=(width, height), format=kind)
            image.sync_with_audio = True
            await self.push_frame(image)
        elif isinstance(piece, SoundPiece):
            sound = piece.samples.astype("<i2").tobytes()
            frame = TTSAudioRawFrame(audio=sound, sample_rate=piece.rate_hz, num_channels=1, context_id=self._context)
            await self.push_frame(frame)
        elif isinstance(piece, SegmentEnd) and piece.text is None:
            self._going = max(0, self._going - 1)
            await self._let_go()
            self._still.set()

    async def _let_go(self) -> None:
        """Pass on what has waited for the end of a sound, and what follows until the next one's."""
        stopped = False
        while self._held and not (stopped and isinstance(self._held[0], TTSStoppedFrame)):
            frame = self._held.popleft()
            stopped = stopped or isinstance(frame, TTSStoppedFrame)
            await self._pass(frame, FrameDirection.DOWNSTREAM)

    async def _pass(self, frame: Frame, direction: FrameDirection) -> None:
        if isinstance(frame, TTSStartedFrame):
            self._context = frame.context_id
        await self.push_frame(frame, direction)
