""":class:`SegmentHearing`: the phones of a sound segment, from its words, or else by ear."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import zip_longest
from operator import attrgetter

from agentface.agents.sound_segment import SoundSegment
from agentface.agents.word_fit import fitted, with_end
from agentface.errors import AgentFaceError
from agentface.io.resampler import Resampler
from agentface.speech.live_hearing import LiveHearing
from agentface.speech.phones import Phone
from agentface.speech.recognizer import HEARD_HZ
from agentface.speech.timed_words import Lookup, phones_of_words
from agentface.speech.voices.voice import SILENCE

AHEAD_S = 0.5
"""So far ahead of what is heard the mouth knows what comes, where it has come."""
_MOST_AHEAD_S = 3.0
"""Words that begin later are told later."""
_LONG_AGO_S = 5.0
_MOST_SPELLINGS = 10_000


class SegmentHearing:
    """Follows one segment after the other.

    Args:
        rate_hz: samples a second of the segments.
        pronounce: asked for words that the recogniser's dictionary does not have; None: such words go by ear.

    Raises SpeechError where there is no pocketsphinx.
    """

    def __init__(self, rate_hz: int, pronounce: Lookup | None = None) -> None:
        self._rate_hz = rate_hz
        self._ear = LiveHearing()
        self._pronounce = pronounce
        self._spellings: dict[str, Sequence[str]] = {}
        self._resampler = Resampler(rate_hz, 1, HEARD_HZ)
        self._segment: SoundSegment | None = None
        self._fed = 0
        self._whole = False

    def follow(self, segment: SoundSegment) -> None:
        """Listen to another segment from its beginning on."""
        self._ear.begin()
        self._resampler.end()
        self._segment, self._fed, self._whole = segment, 0, False

    def listen(self) -> tuple[Phone, ...]:
        """The phones of the segment, in seconds from its beginning, as far as they are known."""
        segment = self._segment
        if segment is None:
            return ()
        until = min(segment.given + round(AHEAD_S * self._rate_hz), segment.received)
        if until > self._fed:
            self._ear.feed(self._resampler.feed(segment.between(self._fed, until)))
            self._fed = until
        if segment.ended and until == segment.received and not self._whole:
            self._ear.feed(self._resampler.end())
            self._ear.end()
            self._whole = True
        heard = self._ear.phones
        if not self._whole and heard and heard[-1].symbol == SILENCE:
            heard = heard[:-1]  # what it has not made up its mind about is no pause
        return self._with_words(heard, segment)

    def _with_words(self, heard: Sequence[Phone], segment: SoundSegment) -> tuple[Phone, ...]:
        """Words, timed inside by what is heard, and what is heard where there are none."""
        now = segment.given / self._rate_hz
        first, last = now - _LONG_AGO_S, now + _MOST_AHEAD_S
        near = sorted((word for word in segment.words if first <= word.start_s <= last), key=attrgetter("start_s"))
        told: list[Phone] = []
        for word, after in zip_longest(near, near[1:]):
            phones = phones_of_words([with_end(word, after, heard)], self._lookup)
            told += fitted(phones, heard) if phones else ()
        if not told:
            return tuple(heard)
        alone = [
            phone for phone in heard if all(phone.end_s <= word.start_s or phone.start_s >= word.end_s for word in told)
        ]
        return tuple(sorted((*told, *alone), key=lambda phone: phone.start_s))

    def _lookup(self, word: str) -> Sequence[str]:
        if word not in self._spellings:
            if len(self._spellings) >= _MOST_SPELLINGS:
                self._spellings.clear()
            self._spellings[word] = self._ear.pronounce(word) or self._asked(word)
        return self._spellings[word]

    def _asked(self, word: str) -> Sequence[str]:
        try:
            return () if self._pronounce is None else self._pronounce(word)
        except AgentFaceError:
            return ()
