""":class:`SoundSegment`: a sound that comes in pieces and goes in pieces."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Iterable

import numpy as np

from agentface.errors import InvalidValueError
from agentface.io.resampler import Resampler
from agentface.speech.sound import Samples
from agentface.speech.timed_words import TimedWord

MOST_WORDS = 5000


class SoundSegment:
    """One sound, in samples of ``rate_hz`` a second, and the words that are known of it; one thread takes.

    Attributes:
        ended: whether all of it has come.
        words: what was told, with times from its beginning.
        given: how many samples have gone.
    """

    def __init__(self, rate_hz: int) -> None:
        self._rate_hz = rate_hz
        self._bytes = bytearray()
        self._format: tuple[int, int] | None = None
        self._resampler: Resampler | None = None
        self._arrivals: deque[tuple[float, int]] = deque()
        self._old = 0
        self._lock = threading.Lock()
        self.words: tuple[TimedWord, ...] = ()
        self.ended = False
        self.given = 0

    @property
    def received(self) -> int:
        """How many samples have come."""
        return len(self._bytes) // 2

    @property
    def over(self) -> bool:
        """Whether all of it has gone."""
        return self.ended and self.given >= self.received

    def push(self, samples: Samples, rate_hz: int, channels: int, now: float) -> None:
        """Take the next piece, ``(N,)`` int16, its channels in turn, that comes ``now``; raises InvalidValueError."""
        with self._lock:
            if self._resampler is None or self._format != (rate_hz, channels) or type(rate_hz) is not int:
                resampler = Resampler(rate_hz, channels, self._rate_hz)  # refuses what is no rate
                self._finish()
                self._resampler, self._format = resampler, (rate_hz, channels)
            self._bytes += self._resampler.feed(samples).tobytes()
            self._arrivals.append((now, self.received))

    def push_words(self, words: Iterable[TimedWord]) -> None:
        """Take what is known of it; raises InvalidValueError when that is too much."""
        words = tuple(words)
        if len(self.words) + len(words) > MOST_WORDS:
            raise InvalidValueError("words", f"at most {MOST_WORDS} in a segment", "more", "end the segment before")
        self.words += words

    def end(self) -> None:
        """No more comes."""
        with self._lock:
            self._finish()
            self.ended = True

    def ready(self, now: float, delay_s: float, most: int) -> int:
        """How many of the next ``most`` samples may go.

        All of them when ``delay_s`` more have come; fewer when that is all that there is, or has been for so long.
        """
        with self._lock:
            waiting = self.received - self.given
            while self._arrivals and self._arrivals[0][0] <= now - delay_s:
                self._old = self._arrivals.popleft()[1]
            if self.ended or self._old >= self.received or waiting - most >= round(delay_s * self._rate_hz):
                return min(waiting, most)
            return most if self._old - self.given >= most else 0

    def take(self, count: int) -> Samples:
        """The next ``count`` samples, or as many as there are."""
        taken = self.between(self.given, self.given + count)
        self.given += len(taken)
        return taken

    def between(self, first: int, last: int) -> Samples:
        """Those samples of a part that have come."""
        with self._lock:
            return np.frombuffer(bytes(self._bytes[2 * first : 2 * last]), np.int16)

    def _finish(self) -> None:
        if self._resampler is not None:
            self._bytes += self._resampler.end().tobytes()
