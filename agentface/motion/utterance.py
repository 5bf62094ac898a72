""":class:`Utterance`: phones that are said as one, and the timeline that shows them."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import replace

from agentface.motion.doing import Doing
from agentface.speech.alphabets import Looks
from agentface.speech.articulation import Articulation, Timeline
from agentface.speech.phones import Phone
from agentface.speech.timeline import segments_of, timeline_of

_KEPT_S = 3.0
"""Of a live utterance, phones that ended so long ago are forgotten: nothing shows them any more."""

_SHORTEST_S = 1e-3
"""No utterance is over as soon as it begins, and what begins so much earlier begins at the same time."""


class Utterance:
    """What is said as one.

    Args:
        phones: in s from ``start``, one after the other.
        looks: what each shows.
        start: s from the beginning of the utterance to the time 0 of its phones.
        rate: how many times as fast it is said.
        loudness: 1 for a usual voice.
        live: whether more may come.

    Attributes:
        doing: whether it waits, is said, or is over.
        told: its phones, as they were told.
    """

    def __init__(
        self,
        articulation: Articulation,
        phones: Sequence[Phone],
        looks: Sequence[Looks],
        start: float = 0.0,
        rate: float = 1.0,
        loudness: float = 1.0,
        live: bool = False,
    ) -> None:
        self._articulation, self._loudness, self.live = articulation, loudness, live
        self.doing = Doing()
        self.told = tuple(phones)
        self._phones = [_moved(phone, start, rate) for phone in phones]
        self._looks = list(looks)
        self._starts = [phone.start_s for phone in self._phones]
        self._began = 0.0
        self.timeline = self._laid_out()

    @property
    def end(self) -> float:
        """When the last phone ends, on the clock that it was begun on, s; after its beginning."""
        return self._began + max(self._phones[-1].end_s, _SHORTEST_S)

    def begin(self, now: float) -> None:
        """It begins; ``now`` in s is the clock that all times from here on are on."""
        self._began = now
        self.doing.begun = True

    @property
    def began(self) -> float:
        """When it began, on that clock."""
        return self._began

    def sounds(self, after: float, until: float) -> Iterator[tuple[str, float, float]]:
        """The main viseme, the start and the length in s of the sounds that begin after a time, until another one."""
        first, end = (bisect_right(self._starts, self.local(time)) for time in (after, until))
        for phone, look in zip(self._phones[first:end], self._looks[first:end], strict=True):
            yield look[0].visemes[0][0], self._began + phone.start_s, phone.end_s - phone.start_s

    def local(self, now: float) -> float:
        """A time of the clock on the utterance's timeline."""
        return now - self._began

    def phone(self, now: float) -> str | None:
        """The symbol that is said now."""
        time = self.local(now)
        return next((phone.symbol for phone in self._phones if phone.start_s <= time < phone.end_s), None)

    def revise(self, start: float, rate: float, phones: Sequence[Phone], looks: Sequence[Looks]) -> None:
        """From the first of ``phones`` on, say these instead; ``start``: the time 0 of theirs on the clock."""
        time = self.local(start)
        fresh = [_moved(phone, time, rate) for phone in phones]
        first = fresh[0].start_s
        kept = [
            (replace(phone, end_s=min(phone.end_s, first)), look)
            for phone, look in zip(self._phones, self._looks, strict=True)
            if phone.start_s < first - _SHORTEST_S and phone.end_s > time - _KEPT_S  # what begins with it is revised
        ]
        self._phones = [*(phone for phone, _ in kept), *fresh]
        self._looks = [*(look for _, look in kept), *looks]
        self._starts = [phone.start_s for phone in self._phones]
        self.timeline = self._laid_out()

    def _laid_out(self) -> Timeline:
        rules = self._articulation.rules
        segments = segments_of(self._phones, self._looks, rules.rate.normal_s)
        return timeline_of(segments, self._articulation, self._loudness)


def _moved(phone: Phone, start: float, rate: float) -> Phone:
    return replace(phone, start_s=start + phone.start_s / rate, end_s=start + phone.end_s / rate)
