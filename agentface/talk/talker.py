""":class:`Talker`: what makes a face say a text."""

from __future__ import annotations

import math
import weakref
from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from heapq import heappop, heappush
from itertools import count
from typing import Any, Protocol

from agentface.emotion.state import NEUTRAL
from agentface.errors import AgentFaceError, InvalidValueError
from agentface.motion.doing import Doing
from agentface.requests import Hush, Neutral, Request, SetEmotion, SetEmotions, Speak
from agentface.speech.sound import Sound
from agentface.speech.spoken import Spoken
from agentface.speech.synthesizer import Done, Order, Synthesizer
from agentface.speech.tags import Tag

MOST_TEXTS = 64
"""So many texts may wait to be said."""
_TAG_FADE_S = 0.25
USUAL_LEVEL = 0.7
"""How strong an emotion is whose tag does not say it."""
LEAD_S = 0.3
"""So long before its turn a sentence is told to the mouth, which rounds early for what comes."""
_SAME_S = 1e-9
_RETURN_S = 0.8
"""What the face takes to let go of what the tags of a text asked for, when it is said."""


class _Mouth(Protocol):
    """What a talker asks of the channel of speech."""

    @property
    def status(self) -> Mapping[str, Any] | None:
        """``ends_in_s`` of what is said; None where nothing is."""


class _Mouths(Protocol):
    """Channels, the mouth among them."""

    @property
    def speech(self) -> _Mouth:
        """The channel of speech."""


class Talking(Protocol):
    """What a talker needs of its face."""

    @property
    def channels(self) -> _Mouths:
        """The channels by name."""

    @property
    def emotion(self) -> Mapping[str, float]:
        """Target intensities."""

    def apply(self, request: Request) -> object:
        """Do what is asked."""


@dataclass(frozen=True, eq=False, slots=True)
class _Said:
    """A text that is said or waits, who is to speak it, None when it is spoken, and what becomes of it."""

    text: str
    order: Order | None
    doing: Doing


@dataclass(frozen=True, slots=True)
class _Turn:
    """A sentence of a text whose turn comes, None for one that failed, and whether its text ends with it.

    It begins no earlier than ``not_before``, on the talker's clock.
    """

    said: _Said
    spoken: Spoken | None
    last: bool
    interrupt: bool = False
    not_before: float = 0.0


class Talker:
    """Has texts spoken in the background; each sentence is shown, and heard, as soon as its turn has come.

    Time is what :meth:`advance` is given. All calls are for the thread that steps the face.

    Attributes:
        heard: called with each sentence's sound, and in how many seconds it begins.
        hushed: called when what is heard has to end.
        ended: called with each text when it is said.
        failed: called with what went wrong with a text, which then ends.
        error: what went wrong last; None before anything has.
        latency_s: how much later than it is given to ``heard`` a sound is heard.
    """

    def __init__(self, face: Talking, synthesizer: Synthesizer | None = None) -> None:
        self._face: Talking = weakref.proxy(face)
        self._synthesizer = synthesizer or Synthesizer()
        self.heard: list[Callable[[Sound, float], object]] = []
        self.hushed: list[Callable[[], object]] = []
        self.ended: list[Callable[[str], object]] = []
        self.failed: list[Callable[[AgentFaceError], object]] = []
        self.error: AgentFaceError | None = None
        self.latency_s = 0.0
        self._now = self._free = 0.0
        self._events: list[tuple[float, int, Callable[[], None]]] = []
        self._order = count()
        self._orders: deque[Order] = deque()
        self._turns: deque[_Turn] = deque()
        self._texts: deque[_Said] = deque()
        self._interrupt = self._own = False
        self._before: dict[str, float] = {}
        weakref.finalize(self, self._synthesizer.close)

    @property
    def texts(self) -> tuple[str, ...]:
        """What is being said and what waits."""
        return tuple(said.text for said in self._texts)

    @property
    def now_s(self) -> float:
        """Its time: the sum of what :meth:`advance` was given, in seconds."""
        return self._now

    @property
    def due_s(self) -> float:
        """In how many seconds something is to happen, so that nobody steps over it; infinite where nothing is."""
        event = self._events[0][0] if self._events else math.inf
        turn = self._free - LEAD_S if self._turns and self._free - LEAD_S > self._now + _SAME_S else math.inf
        return max(min(event, turn) - self._now, 0.0)

    def say(self, text: str, order: Order, *, interrupt: bool = False) -> Doing:
        """Say a text when its turn has come, or in place of all others; raises InvalidValueError when too many wait."""
        said = self._admit(text, order, interrupt)
        self._orders.append(order)
        return said.doing

    def perform(self, spoken: Spoken, *, interrupt: bool = False, in_s: float = 0.0) -> Doing:
        """Say what is spoken already, ``in_s`` seconds from now at the earliest; likewise.

        Told ``LEAD_S`` before, the mouth rounds early for it.
        """
        said = self._admit(spoken.text, None, interrupt)
        turn = _Turn(said, spoken, last=True, interrupt=self._take_interrupt(), not_before=self._now + in_s)
        self._turns.append(turn)
        return said.doing

    @property
    def busy(self) -> bool:
        """Whether anything is said, by whomever."""
        return bool(self._texts) or self._others_speak()

    def wait(self) -> None:
        """Until all sentences are spoken that were asked for: nothing is late then, however the face is stepped."""
        self._pass_on()
        self._synthesizer.wait()

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass, at most ``due_s`` for what is then to be in its time; 0 begins what is ready."""
        self._now += dt
        self._pass_on()
        while self._events and self._events[0][0] <= self._now + _SAME_S:
            heappop(self._events)[2]()
        while (done := self._synthesizer.take()) is not None:
            self._take(done)
        while self._turns and self._free <= self._now + LEAD_S + _SAME_S:
            if not self._turns[0].interrupt and self._others_speak():
                break
            self._begin(self._turns.popleft())

    def notice(self, request: Request) -> None:
        """End what is said when the face is told to be quiet or to say something else at once.

        What tells it what to feel outlasts the text.
        """
        if self._own:
            return
        if isinstance(request, Hush) or (isinstance(request, Speak) and request.interrupt):
            self.stop()
        elif isinstance(request, SetEmotion):
            self._before.pop(request.emotion, None)
        elif isinstance(request, SetEmotions | Neutral):
            self._before.clear()

    def stop(self) -> None:
        """Say nothing more; the mouth is told apart."""
        self._synthesizer.drop()
        self._orders.clear()
        self._turns.clear()
        self._events.clear()
        texts, self._texts = self._texts, deque()
        for said in texts:
            said.doing.end(whole=False)
        self._free = self._now
        self._let_go(_TAG_FADE_S)
        for tell in self.hushed:
            tell()

    def close(self) -> None:
        """End the voices."""
        self._synthesizer.close()

    def _pass_on(self) -> None:
        while self._orders:
            self._synthesizer.ask(self._orders.popleft())

    def _admit(self, text: str, order: Order | None, interrupt: bool) -> _Said:
        if not interrupt and len(self._texts) >= MOST_TEXTS:
            raise InvalidValueError("text", f"at most {MOST_TEXTS} texts waiting", "one more", "send it later, or hush")
        if interrupt and self._texts:
            self.stop()
        self._interrupt |= interrupt
        said = _Said(text, order, Doing())
        self._texts.append(said)
        return said

    def _take_interrupt(self) -> bool:
        interrupt, self._interrupt = self._interrupt, False
        return interrupt

    def _take(self, done: Done) -> None:
        said = next(said for said in self._texts if said.order is done.order)
        if done.error is not None:
            self._fail(said, done.error)
        self._turns.append(_Turn(said, done.spoken, done.last, self._take_interrupt()))

    def _begin(self, turn: _Turn) -> None:
        start = max(self._free, max(self._now, turn.not_before) + self.latency_s)
        turn.said.doing.begun = True
        if turn.spoken is not None and turn.said.doing.outcome is None:
            self._say(turn.said, turn.spoken, start, turn.interrupt)
            self._free = start + turn.spoken.duration_s
        if turn.last:
            self._at(self._free, partial(self._end, turn.said))

    def _say(self, said: _Said, spoken: Spoken, start: float, interrupt: bool) -> None:
        in_s = start - self._now
        try:
            self._ask(Speak(spoken.phones, in_s, interrupt=interrupt, live=True))
        except AgentFaceError as error:  # phones of a voice that the mouth does not know
            self._fail(said, error)
            return
        for at, tag in spoken.tags:
            self._at(start + at, partial(self._show, tag))
        for tell in self.heard:
            tell(spoken.sound, in_s - self.latency_s)

    def _fail(self, said: _Said, error: AgentFaceError) -> None:
        self.error = said.doing.error = error
        for tell in self.failed:
            tell(error)

    def _ask(self, request: Request) -> None:
        self._own = True
        try:
            self._face.apply(request)
        finally:
            self._own = False

    def _others_speak(self) -> bool:
        """Whether the mouth says what is not ours; an utterance of ours that is over waits for more."""
        status = self._face.channels.speech.status
        return status is not None and self._free <= self._now and status["ends_in_s"] > 0.0

    def _at(self, time: float, happens: Callable[[], None]) -> None:
        heappush(self._events, (time, next(self._order), happens))

    def _end(self, said: _Said) -> None:
        self._texts.remove(said)
        said.doing.end(whole=said.doing.error is None)
        self._let_go(_RETURN_S)
        for tell in self.ended:
            tell(said.text)

    def _show(self, tag: Tag) -> None:
        """Show the emotion of a tag in place of those of the tags before it."""
        if tag.name == NEUTRAL:
            self._before.clear()
            self._ask(SetEmotion(NEUTRAL, 1.0 if tag.level is None else tag.level, _TAG_FADE_S))
            return
        before = self._before.pop(tag.name, self._face.emotion[tag.name])
        self._let_go(_TAG_FADE_S)
        self._before[tag.name] = before
        self._ask(SetEmotion(tag.name, USUAL_LEVEL if tag.level is None else tag.level, _TAG_FADE_S))

    def _let_go(self, fade: float) -> None:
        before, self._before = self._before, {}
        for name, level in before.items():
            self._ask(SetEmotion(name, level, fade))
