""":class:`SegmentQueue`: what a speaker has still to say."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterable
from typing import TypeAlias

from agentface.agents.sound_segment import SoundSegment
from agentface.errors import AgentFaceError, InvalidValueError
from agentface.face import Face
from agentface.motion.doing import Doing
from agentface.requests import Say
from agentface.speech.sound import Samples
from agentface.speech.timed_words import TimedWord
from agentface.talk.talker import MOST_TEXTS

MOST_SOUND_S = 600.0
"""So much sound may wait."""


class TextSegment:
    """A text, and what becomes of it.

    Attributes:
        say: what is asked of the face.
        doing: None until the face was asked to say it.
        error: what went wrong.
    """

    def __init__(self, say: Say) -> None:
        self.say = say
        self.doing: Doing | None = None
        self.error: AgentFaceError | None = None

    @property
    def over(self) -> bool:
        """Whether it was said, or will not be."""
        if self.doing is not None and self.doing.outcome is not None:
            self.error = self.error or self.doing.error
            return True
        return False

    def begin(self, face: Face) -> None:
        """Have a face say it when its turn has come."""
        self.doing = Doing()
        try:
            doing = face.apply(self.say)
        except AgentFaceError as error:
            self.error = error
            self.doing.end(whole=False)
        else:
            self.doing = doing or self.doing


Segment: TypeAlias = TextSegment | SoundSegment


class SegmentQueue:
    """Texts and sounds in their turn; any thread may push and clear, one takes.

    Args:
        rate_hz: samples a second of the sounds as they go.
    """

    def __init__(self, rate_hz: int) -> None:
        self._rate_hz = rate_hz
        self._lock = threading.Lock()
        self._segments: deque[Segment] = deque()
        self._open: SoundSegment | None = None
        self._cleared = False

    def push_text(self, say: Say) -> None:
        """Put a text at the end; raises InvalidValueError when too many wait."""
        with self._lock:
            self._close()
            self._add(TextSegment(say))

    def push_sound(self, samples: Samples, rate_hz: int, channels: int, now: float) -> None:
        """Put sound at the end of the open segment, or begin one; raises InvalidValueError."""
        with self._lock:
            waiting = sum(s.received - s.given for s in self._segments if isinstance(s, SoundSegment))
            if waiting > MOST_SOUND_S * self._rate_hz:
                raise InvalidValueError("sound", f"at most {MOST_SOUND_S:g} s waiting", "more", "push it later")
            segment = self._open or SoundSegment(self._rate_hz)
            segment.push(samples, rate_hz, channels, now)
            self._opened(segment)

    def push_words(self, words: Iterable[TimedWord]) -> None:
        """Tell words of the open segment, or begin one; raises InvalidValueError."""
        with self._lock:
            segment = self._open or SoundSegment(self._rate_hz)
            segment.push_words(words)
            self._opened(segment)

    def end(self) -> None:
        """What is open is whole."""
        with self._lock:
            self._close()

    def clear(self) -> None:
        """Forget all of it."""
        with self._lock:
            self._segments.clear()
            self._open = None
            self._cleared = True

    def take_cleared(self) -> bool:
        """Whether it was cleared since the last time."""
        with self._lock:
            cleared, self._cleared = self._cleared, False
            return cleared

    def drop(self, segment: Segment) -> bool:
        """Take out the first one, which is over; False when it is not the first one any more."""
        with self._lock:
            if not self._segments or self._segments[0] is not segment:
                return False
            self._segments.popleft()
            return True

    @property
    def first(self) -> Segment | None:
        """What is to be said now."""
        with self._lock:
            return self._segments[0] if self._segments else None

    @property
    def texts(self) -> tuple[TextSegment, ...]:
        """The texts before the first sound."""
        found: list[TextSegment] = []
        with self._lock:
            for segment in self._segments:
                if isinstance(segment, SoundSegment):
                    break
                found.append(segment)
        return tuple(found)

    def __len__(self) -> int:
        return len(self._segments)

    def _opened(self, segment: SoundSegment) -> None:
        if self._open is None:
            self._add(segment)
            self._open = segment

    def _close(self) -> None:
        if self._open is not None:
            self._open.end()
            self._open = None

    def _add(self, segment: Segment) -> None:
        if len(self._segments) >= MOST_TEXTS:
            raise InvalidValueError("segment", f"at most {MOST_TEXTS} waiting", "one more", "push it later, or clear")
        self._segments.append(segment)
