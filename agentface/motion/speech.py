"""What the mouth says: phones in time, one utterance after the other, and single visemes."""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from agentface.conventions import Doubles
from agentface.errors import UnknownNameError
from agentface.kernel import can_compile
from agentface.motion.conflicts import SpeechYields, default_conflicts
from agentface.motion.doing import Doing
from agentface.motion.envelope import Envelope
from agentface.motion.following import Follower, Following
from agentface.motion.utterance import Utterance
from agentface.motion.yielding import Yielding
from agentface.speech.alphabets import Part, PhoneTable, phone_table
from agentface.speech.articulation import Articulation, default_articulation
from agentface.speech.phones import Phone

HUSH_S = 0.14
"""So long the mouth takes to let go of what it was saying."""
JOIN_S = 0.1
"""So long it takes to come from what it shows into what it is told to say at once."""
VISEME_S = 0.1
"""So long a single viseme takes to come and to go."""
GRACE_S = 0.3
"""So long a live utterance waits for more before it is over."""
_TAIL_S = 2.5
"""So long after its end an utterance may still be seen."""
_FURTHEST = 16.0
"""No number of a sample is farther from that of another."""
_SAME = 1e-6
"""Samples that differ by less, and speeds by what that is in ``JOIN_S``, are one."""
_NEAR_S = 1e-3
"""Over so long a speed is measured."""


class SpeechChannel:
    """One utterance at a time; what is asked meanwhile waits its turn. Times are sums of the ``dt`` of ``advance``.

    What it shows is what the utterance's timeline says, and beside it a rest of what was shown before, which goes to
    nothing: there is no jump when an utterance begins, is revised or is replaced half-way.

    Args:
        compiled: False for numpy instead of the compiled kernel.
        yields: how what the face feels gives way; that of ``rules/conflicts.yaml`` when None.
    """

    def __init__(self, *, compiled: bool = True, yields: SpeechYields | None = None) -> None:
        self.articulation: Articulation = default_articulation()
        self.ended: list[Callable[[], None]] = []
        """Called once for every utterance: when it has been said, and when it is interrupted or is never begun."""
        self._yielding = Yielding(self.articulation, yields or default_conflicts().yields, compiled=compiled)
        self.names = self._yielding.names
        self._compiled = compiled and can_compile()
        self._now = 0.0
        self._current: Utterance | None = None
        self._shown: Utterance | None = None
        self._waiting: deque[Utterance] = deque()
        self._hushed = math.inf
        self._following: Following | None = None
        self._ended_at = 0.0
        size = self.articulation.size
        self._rest = Envelope(size, -_FURTHEST, _FURTHEST, compiled=compiled)
        self._sample, self._ahead = np.zeros(size), np.zeros(size)
        self._scratch = np.zeros(len(self.articulation.articulators))
        self._visemes = Envelope(len(self.articulation.visemes), compiled=compiled)
        self._until = [math.inf] * len(self.articulation.visemes)

    def follow(self, follower: Follower) -> None:
        """Tell ``follower``, which is advanced after this channel, of all that is said."""
        self._following = Following(follower)

    @property
    def speaking(self) -> bool:
        """Whether an utterance is being said."""
        return self._current is not None

    @property
    def status(self) -> dict[str, Any] | None:
        """``phone``, null in a pause; ``ends_in_s``; ``waiting`` utterances; None where nothing is said."""
        if self._current is None:
            return None
        ends_in = max(self._current.end - self._now, 0.0)
        phone = self._current.phone(self._now)
        return {"phone": phone, "ends_in_s": round(ends_in, 3), "waiting": len(self._waiting)}

    def speak(
        self,
        phones: Sequence[Phone],
        *,
        start: float = 0.0,
        rate: float = 1.0,
        loudness: float = 1.0,
        interrupt: bool = False,
        live: bool = False,
        alphabet: str | None = None,
    ) -> Doing | None:
        """Say ``phones``, whose times count from ``start`` s after now, or after all that is said and waits before.

        With ``interrupt`` they are said at once, and what was said or waited is dropped. With ``live`` their times
        count from now whatever is said: what a live utterance would have said from the first of them on is replaced,
        so that it grows, or is revised. Returns what goes on now, if there is anything to say. Raises UnknownNameError
        for a phone or an alphabet, and then nothing happens.
        """
        looks = self._table.looks([phone.symbol for phone in phones], alphabet)
        if not phones:
            if interrupt:
                self.hush()
            return None
        if live and not interrupt and self._current is not None and self._current.live:
            self._join(lambda current: current.revise(self._now + start, rate, phones, looks))
            return self._current.doing
        utterance = Utterance(self.articulation, phones, looks, start, rate, loudness, live)
        if interrupt:
            self._drop()
        self._waiting.append(utterance)
        if self._current is None:
            self._begin_next()
        return utterance.doing

    def hush(self) -> None:
        """Say no more; the mouth is back to what the face shows within ``HUSH_S``."""
        self._visemes.move(0.0, HUSH_S)
        self._until = [math.inf] * len(self._until)
        if self._shown is not None or not self._rest.resting:
            self._hushed = min(self._hushed, self._now)
        self._drop()

    def take_back(self, phones: Sequence[Phone]) -> None:
        """Do not say what waits with these phones, the last of those that do; nothing where none does."""
        waiting = [each for each in self._waiting if each.told == tuple(phones) and each.doing.outcome is None]
        if waiting:
            waiting[-1].doing.end(whole=False)

    def show(self, name: str, weight: float, duration: float | None = None) -> None:
        """Show a viseme at a weight 0..1 beside other such, until told otherwise or for ``duration`` s."""
        visemes = self.articulation.visemes
        if name not in visemes:
            raise UnknownNameError("viseme", name, visemes)
        place = visemes.index(name)
        self._visemes.move(weight, VISEME_S, [place])
        self._until[place] = math.inf if duration is None else self._now + duration

    def release(self, fade: float) -> None:
        """Let go of single visemes; what is being said goes on, :meth:`hush` ends it."""
        self._visemes.move(0.0, fade)
        self._until = [math.inf] * len(self._until)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        begin, end = self._now, self._now + dt
        while (event := self._next_event()) <= end:
            self._pass(max(event, self._now))
            self._happen()
        self._pass(end)
        if self._following is not None:
            self._following.tell(self._current, begin, end, self._ended_at)

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """What is said now, and how much of what is felt it leaves."""
        if self._shown is None and self._rest.resting and self._visemes.resting:
            return False
        sample = self._sample
        self._tell(self._now, sample)
        sample += self._rest.value
        if not self._visemes.resting:
            sample += (1.0 - min(max(sample[-1], 0.0), 1.0)) * self._mixed()
        self._yielding.write(sample, values, weights)
        return True

    def warm_up(self) -> None:
        """Load or compile now what the first frame of speech needs."""
        self._sampler  # noqa: B018  # made by being looked at

    @cached_property
    def _table(self) -> PhoneTable:
        return phone_table()

    @cached_property
    def _sampler(self) -> Callable[[Utterance, float, Doubles], None]:
        ramps, scratch = self.articulation.ramps, self._scratch
        if self._compiled:
            from agentface.speech import coarticulation_compiled

            kernel = coarticulation_compiled.sample
            return lambda utterance, time, out: kernel(utterance.timeline, ramps, time, scratch, out)
        from agentface.speech import coarticulation

        return lambda utterance, time, out: coarticulation.sample(utterance.timeline, ramps, time, out)

    @cached_property
    def _poses(self) -> Doubles:
        """``(visemes, size)``: what a single viseme wants."""
        parts = [Part(((name, 1.0),), 0.0, 1.0, 1.0) for name in self.articulation.visemes]
        rows = [[*self.articulation.target(part), self.articulation.tight(part), 1.0] for part in parts]
        return np.array(rows, np.float64)

    def _mixed(self) -> Doubles:
        weights = self._visemes.value
        return np.asarray(weights @ self._poses / max(float(weights.sum()), 1.0))

    def _tell(self, time: float, out: Doubles) -> None:
        """What the utterance wants at a time, as far as it is not hushed."""
        if self._shown is None:
            out[:] = 0.0
            return
        self._sampler(self._shown, self._shown.local(time), out)
        if time > self._hushed:
            out *= 0.5 + 0.5 * math.cos(math.pi * min((time - self._hushed) / HUSH_S, 1.0))

    def _next_event(self) -> float:
        """When something happens by itself next: inf for never."""
        next_ = min(self._until)
        if self._current is not None:
            next_ = min(next_, self._over(self._current))
        if self._shown is not None and self._current is None:
            next_ = min(next_, self._gone(self._shown))
        return next_

    def _gone(self, utterance: Utterance) -> float:
        return min(self._hushed + HUSH_S, utterance.end + _TAIL_S)

    @staticmethod
    def _over(utterance: Utterance) -> float:
        return utterance.end + (GRACE_S if utterance.live else 0.0)

    def _happen(self) -> None:
        """Do what is due now."""
        due = [place for place, until in enumerate(self._until) if until <= self._now]
        for place in due:
            self._until[place] = math.inf
        if due:
            self._visemes.move(0.0, VISEME_S, due)
        if self._current is not None and self._over(self._current) <= self._now:
            self._tell_ended(self._current, whole=True)
            self._begin_next()
        elif self._current is None and self._shown is not None and self._gone(self._shown) <= self._now:
            self._shown, self._hushed = None, math.inf

    def _pass(self, time: float) -> None:
        dt = time - self._now
        self._now = time
        self._rest.advance(dt)
        self._visemes.advance(dt)

    def _begin_next(self) -> None:
        while self._current is None and self._waiting and self._waiting[0].doing.outcome is not None:
            self._tell_ended(self._waiting.popleft(), whole=False)  # taken back while it waited
        if self._current is not None or not self._waiting:
            return
        utterance = self._waiting.popleft()
        utterance.begin(self._now)

        def turn(_: Utterance) -> None:
            self._shown, self._hushed = utterance, math.inf

        self._current = utterance
        self._join(turn)

    def _join(self, change: Callable[[Utterance], None]) -> None:
        """Change what is said, and let what was shown until now go over into it."""
        before, speed = self._told()
        assert self._current is not None, "something is said"  # noqa: S101 - for the type checker
        change(self._current)
        wanted, ahead = self._told()
        if np.abs(before - wanted).max() < _SAME and np.abs(speed - ahead).max() < _SAME / JOIN_S:
            return  # a transition that goes on comes to its end in time, however often the same is told
        self._rest.glide(before + self._rest.value - wanted, speed + self._rest.velocity - ahead, JOIN_S)

    def _told(self) -> tuple[Doubles, Doubles]:
        """What is wanted now, and its change a second."""
        self._tell(self._now, self._sample)
        self._tell(self._now + _NEAR_S, self._ahead)
        return self._sample.copy(), (self._ahead - self._sample) / _NEAR_S

    def _drop(self) -> None:
        """Forget what is said and what waits; what is shown stays."""
        dropped = [*filter(None, [self._current]), *self._waiting]
        self._waiting.clear()
        for utterance in dropped:
            self._tell_ended(utterance, whole=False)

    def _tell_ended(self, utterance: Utterance, *, whole: bool) -> None:
        utterance.doing.end(whole=whole)
        if utterance is self._current:
            self._current, self._ended_at = None, self._now
        for call in tuple(self.ended):
            call()
