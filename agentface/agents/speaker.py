""":class:`Speaker`: text or sound goes in, the talking face comes out, as pictures and sound in time."""

from __future__ import annotations

from collections.abc import AsyncIterator, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import Self

import numpy as np

from agentface.agents.drawing import Drawing, Painter
from agentface.agents.live_mouth import LiveMouth
from agentface.agents.pace import Pace
from agentface.agents.pieces import Piece, SegmentEnd, SoundPiece, VideoFrame
from agentface.agents.segment_hearing import SegmentHearing
from agentface.agents.segments import Segment, SegmentQueue
from agentface.agents.sound_line import SoundLine
from agentface.agents.sound_segment import SoundSegment
from agentface.clock import Clock, SystemClock
from agentface.conventions import check_range, check_rate
from agentface.errors import InvalidValueError
from agentface.face import Face
from agentface.requests import Hush, Say
from agentface.speech.recognizer import check_recognizer
from agentface.speech.sound import Samples, Sound
from agentface.speech.timed_words import Lookup, TimedWord

DELAY_S = 0.2
"""Sound that comes as fast as it is heard is held back so long, so that the mouth knows what comes."""
AHEAD_S = 0.1
"""So long before its time a piece is given out while something is said, so that whoever plays it never waits."""
_USUAL = Drawing()


class Speaker:
    """A face that speaks what it is given, for programs that pass its pictures and its sound on.

    ``say`` takes a text; ``push_sound`` sound as it comes, and ``push_words`` the times of its words where they are
    known, until ``end_segment``. What is pushed is said one after the other. ``async for piece in speaker``, or
    ``take`` without asyncio, gives for each instant, whether or not anything is said, a ``VideoFrame`` and the
    ``SoundPiece`` that is heard from there on; and a ``SegmentEnd`` after each text and each sound. Whoever is late
    gets fewer frames and all of the sound.

    What is said in a sound is known by its words, or else heard by pocketsphinx; both in English. Sound goes
    ``delay_s`` after it came, or as soon as so much more has come. Of sound that dries up before its end was told the
    rest goes, and the mouth holds.

    All of it may be called from any thread. The face is stepped and drawn in a thread of the speaker's own: what is
    asked of it meanwhile is for ``face.ask``.

    Args:
        face: what speaks; it stays the caller's to close.
        drawing: how its pictures look; None for geometry instead.
        look: of its pictures, the name of one of the face's looks or a path; the face's own when None.
        fps: frames a second, more than 0 and at most 1000.
        rate_hz: samples a second of what is heard, a whole number in 4000..192000.
        delay_s: 0.05..2.
        ahead_s: so long before its time a piece is given out while something is said, 0..1; else at its time.
        pronounce: asked for words that the recogniser's dictionary does not have, such as ``Flite().pronounce``.
        clock: the time of the frames, and what waits for it; a ``FrameClock`` waits for nothing.

    Raises InvalidValueError.
    """

    def __init__(
        self,
        face: Face,
        drawing: Drawing | None = _USUAL,
        *,
        look: str | None = None,
        fps: float = 25.0,
        rate_hz: int = 24_000,
        delay_s: float = DELAY_S,
        ahead_s: float = AHEAD_S,
        pronounce: Lookup | None = None,
        clock: Clock | None = None,
    ) -> None:
        self.face, self.drawing = face, drawing
        self.fps, self.delay_s = check_rate("fps", fps), check_range("delay_s", delay_s, 0.05, 2.0)
        self.ahead_s = check_range("ahead_s", ahead_s, 0.0, 1.0)
        self._line = SoundLine(rate_hz)
        self.rate_hz = self._line.rate_hz
        self._clock, self._pronounce = clock or SystemClock(), pronounce
        self._queue = SegmentQueue(self.rate_hz)
        self._mouth, self._painter = LiveMouth(face), Painter(face.model, look)
        self._hearing: SegmentHearing | None = None
        self._followed: SoundSegment | None = None
        self._pace, self._slot = Pace(self._clock, self.fps), -1
        self._step_began_s = self._talked_s = 0.0
        face.talker.latency_s = 1.0 / self.fps
        face.talker.heard.append(self._hear)
        face.talker.hushed.append(self._line.clear)
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="agentface-speaker")
        self._closed = False

    @property
    def busy(self) -> bool:
        """Whether something is said, or waits."""
        return len(self._queue) > 0

    def say(self, text: str, *, voice: str | None = None, language: str = "en", rate: float = 1.0) -> None:
        """Say a text, with words in brackets as in ``Face.say``; ends an open sound.

        Raises InvalidValueError, UnknownNameError; what goes wrong with its voice is told by its ``SegmentEnd``.
        """
        self._queue.push_text(Say(text, voice, language, rate))

    def push_sound(self, samples: bytes | Samples, rate_hz: int, channels: int = 1) -> None:
        """Say the next piece of a sound.

        Args:
            samples: int16, in little-endian bytes or ``(N,)``, its channels in turn.
            rate_hz: samples a second of a channel, 4000..192000.
            channels: 1..8; they are mixed.

        Raises InvalidValueError, also for more than ten minutes that wait; SpeechError without pocketsphinx.
        """
        check_recognizer()
        self._queue.push_sound(_as_samples(samples), rate_hz, channels, self._clock.now())

    def push_words(self, words: Iterable[TimedWord | Sequence[object]]) -> None:
        """Tell words of the sound that is pushed, by their times in seconds from its beginning.

        Each is a ``TimedWord``, or a text, its start and, if it is known, its end. Raises InvalidValueError.
        """
        self._queue.push_words(tuple(map(_as_word, words)))

    def end_segment(self) -> None:
        """All of the sound that is pushed has come; what comes next is another one."""
        self._queue.end()

    def clear(self) -> None:
        """Be silent: forget what is said and what waits. Nothing of it is given out any more, no ``SegmentEnd`` too."""
        self._queue.clear()

    def take(self) -> list[Piece]:
        """The next pieces, when their time has come; raises InvalidValueError once it is closed.

        Also raises what drawing raises: GraphicsError.
        """
        if self._closed:
            raise InvalidValueError("Speaker", "one that is not closed", "one after close()", "make a new Speaker")
        return self._thread.submit(self._next).result()

    async def __aiter__(self) -> AsyncIterator[Piece]:
        """The pieces, until it is closed; raises what ``take`` raises."""
        import asyncio

        loop = asyncio.get_running_loop()
        while not self._closed:
            for piece in await loop.run_in_executor(self._thread, self._next):
                yield piece

    def close(self) -> None:
        """End the iteration and the thread, and let go of the face; may be called twice."""
        if not self._closed:
            self._closed = True
            self._thread.shutdown()
            self._painter.close()
            talker = self.face.talker
            talker.latency_s = 0.0
            talker.heard.remove(self._hear)
            talker.hushed.remove(self._line.clear)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _next(self) -> list[Piece]:
        """One frame, and the sound until the next one."""
        if self._closed:
            return []
        if self._slot < 0:
            self._prepare()
        shown_before = max(self._slot, 0)
        frames = self._pace.wait(self.ahead_s if self.busy else 0.0)
        first = self._sample(self._slot + 1)
        self._slot += frames
        shown, last = self._sample(self._slot), self._sample(self._slot + 1)
        if self._queue.take_cleared():
            self.face.apply(Hush())
        segment = self._queue.first
        count = self._ready(segment, last - first, shown_before / self.fps, first / self.rate_hz)
        frame = self._step(shown_before / self.fps)
        samples, ends = self._taken(segment, count, first, last)
        sounds = self._sound(first, samples[: shown - first]), self._sound(shown, samples[shown - first :])
        return [*sounds[0], frame, *sounds[1], *ends]

    def _prepare(self) -> None:
        """Load what the first frames need before their time begins."""
        self.face.warm_up()
        if self.drawing is not None:
            self._painter.draw(self.face.geometry, self.drawing)

    def _sample(self, slot: int) -> int:
        return round(slot * self.rate_hz / self.fps)

    def _ready(self, segment: Segment | None, most: int, now_s: float, heard_s: float) -> int:
        """Have the first segment said: how many samples of it are heard from ``heard_s`` on, ``now_s`` being shown."""
        for text in self._queue.texts:
            if text.doing is None:
                text.begin(self.face)
        if not isinstance(segment, SoundSegment):
            return 0
        if segment is not self._followed:
            self._follow(segment)
        count = segment.ready(self._clock.now(), self.delay_s, most)
        assert self._hearing is not None, "made by _follow"  # noqa: S101 - for the type checker
        phones = self._hearing.listen()
        if count or segment.given:
            self._mouth.tell(phones, now_s, heard_s - segment.given / self.rate_hz)
        return count

    def _follow(self, segment: SoundSegment) -> None:
        if self._hearing is None:
            self._hearing = SegmentHearing(self.rate_hz, self._pronounce)
        self._hearing.follow(segment)
        self._mouth.begin()
        self._followed = segment

    def _step(self, before_s: float) -> VideoFrame:
        time_s = self._slot / self.fps
        self._step_began_s, self._talked_s = before_s, self.face.talker.now_s
        geometry = self.face.step(time_s - before_s)
        if self.drawing is None:
            return VideoFrame(time_s, None, self.face.pose, geometry.copy())
        return VideoFrame(time_s, self._painter.draw(geometry, self.drawing), self.face.pose)

    def _hear(self, sound: Sound, in_s: float) -> None:
        """What the face's talker says."""
        talker = self.face.talker
        now_s = self._step_began_s + talker.now_s - self._talked_s
        self._line.add(now_s + in_s + talker.latency_s, sound)

    def _taken(self, segment: Segment | None, count: int, first: int, last: int) -> tuple[Samples, list[SegmentEnd]]:
        """What is heard from one sample until before another, and what ends there."""
        ends: list[SegmentEnd] = []
        given = np.zeros(0, np.int16)
        if isinstance(segment, SoundSegment) and self._queue.first is segment:
            given = segment.take(count)
            if segment.over and self._queue.drop(segment):
                ends.append(SegmentEnd((first + count) / self.rate_hz))
        for text in self._queue.texts:
            if not text.over or not self._queue.drop(text):
                break
            ends.append(SegmentEnd(last / self.rate_hz, text.say.text, text.error))
        said = self._line.take(first, last)
        if said is None:
            return given, ends
        mixed = said.astype(np.int32)
        mixed[: len(given)] += given
        return np.clip(mixed, -32768, 32767).astype(np.int16), ends

    def _sound(self, first: int, samples: Samples) -> list[SoundPiece]:
        return [SoundPiece(first / self.rate_hz, samples, self.rate_hz)] if len(samples) else []


def _as_samples(samples: bytes | Samples) -> Samples:
    if isinstance(samples, np.ndarray):
        return samples
    if not isinstance(samples, bytes | bytearray | memoryview) or len(bytes(samples)) % 2:
        raise InvalidValueError("sound", "samples of two bytes", type(samples).__name__)
    return np.frombuffer(bytes(samples), "<i2").astype(np.int16)


def _as_word(word: TimedWord | Sequence[object]) -> TimedWord:
    if isinstance(word, TimedWord):
        return word
    if isinstance(word, str) or not isinstance(word, Sequence) or not 2 <= len(word) <= 3:
        raise InvalidValueError("word", "a text, its start in seconds and, if it is known, its end", word)
    return TimedWord(*word)  # type: ignore[arg-type]  # checks what it takes
