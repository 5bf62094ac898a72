""":class:`BlockPlayer`: what plays BML blocks on a face."""

from __future__ import annotations

import math
import weakref
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from heapq import heappop, heappush
from itertools import count, pairwise
from typing import Protocol

from agentface.bml.block import ENDS, STARTS, Aim, Behavior, Block, Nod, SyncPoint, Text
from agentface.bml.table import bml_table
from agentface.bml.timetable import Timetable, schedule
from agentface.errors import AgentFaceError, InvalidValueError
from agentface.motion.doing import Doing
from agentface.requests import Hush, Neutral, Request, SetEmotion, SetEmotions
from agentface.speech.spoken import Spoken, joined
from agentface.speech.synthesizer import Done, Order, Synthesizer
from agentface.talk.block_speech import performed, script_of_speech
from agentface.talk.staging import Staged, Staging
from agentface.talk.talker import LEAD_S

MOST_BLOCKS = 64
"""So many blocks may play and wait."""
_MOST_OVER = 256
"""Of so many that are over, sync points are remembered."""
STOPPED = "stopped"
"""What is told of a block that ends before its time."""
_SAME_S = 1e-9


class SpeechPerformer(Protocol):
    """What says a speech."""

    latency_s: float
    """How much later than it is performed a speech is shown and heard."""

    @property
    def busy(self) -> bool:
        """Whether anything is said."""

    def perform(self, spoken: Spoken, *, interrupt: bool = False, in_s: float = 0.0) -> object:
        """Say what is spoken already, so many seconds from now."""


class BlockFace(Staged, Protocol):
    """What a player needs of its face."""

    @property
    def talker(self) -> SpeechPerformer:
        """What says its speeches."""

    def apply(self, request: Request) -> object:
        """Do what is asked."""


@dataclass(frozen=True, slots=True)
class Progress:
    """How far a block is.

    Attributes:
        block: its id.
        what: ``start``, ``end``, ``stopped``, or a sync point of it as ``behavior:sync``.
        time_s: seconds since the block began.
    """

    block: str
    what: str
    time_s: float


@dataclass(eq=False)
class _Waiting:
    """A block whose turn comes, and what is spoken of it so far."""

    block: Block
    doing: Doing
    parts: dict[str, list[Spoken]] = field(default_factory=dict)
    missing: int = 0


@dataclass(eq=False)
class _Run:
    """A block that plays, since ``start``."""

    block: Block
    doing: Doing
    start: float
    times: Timetable
    speaking: bool = False
    told_early: Spoken | None = None
    over: bool = False


class BlockPlayer:
    """Plays BML blocks, each when its speeches are spoken and its composition lets it.

    Time is what :meth:`advance` is given; all calls are for the thread that steps the face.

    Attributes:
        told: called with every :class:`Progress`.
        failed: called with the id of a block that cannot be played, and what went wrong.
        error: what went wrong last; None before anything has.
    """

    def __init__(self, face: BlockFace, synthesizer: Synthesizer | None = None) -> None:
        self._face: BlockFace = weakref.proxy(face)
        self._synthesizer = synthesizer or Synthesizer()
        self.told: list[Callable[[Progress], object]] = []
        self.failed: list[Callable[[str, AgentFaceError], object]] = []
        self.error: AgentFaceError | None = None
        self._staging = Staging(self._face, self._ask)
        self._now = 0.0
        self._own = False
        self._events: list[tuple[float, int, _Run, Callable[[], None]]] = []
        self._count = count()
        self._waiting: list[_Waiting] = []
        self._runs: list[_Run] = []
        self._over: dict[str, _Run] = {}
        self._orders: list[tuple[Order, _Waiting, str]] = []
        weakref.finalize(self, self._synthesizer.close)

    @property
    def blocks(self) -> tuple[str, ...]:
        """The ids of those that play, and of those that wait."""
        return (*(run.block.id for run in self._runs), *(waiting.block.id for waiting in self._waiting))

    @property
    def due_s(self) -> float:
        """In how many seconds something is to happen, so that nobody steps over it; infinite where nothing is."""
        return max(self._events[0][0] - self._now, 0.0) if self._events else math.inf

    def play(self, block: Block) -> Doing:
        """Play a block when its speeches are spoken; raises InvalidValueError for an id that plays or waits already."""
        if block.id in self.blocks and block.composition != "REPLACE":
            raise InvalidValueError("block id", "one that neither plays nor waits", block.id, "give each block its own")
        if len(self.blocks) >= MOST_BLOCKS:
            raise InvalidValueError("block", f"at most {MOST_BLOCKS} that play or wait", "one more", "send it later")
        waiting = _Waiting(block, Doing(), {name: [spoken] for name, spoken in block.spoken})
        for behavior in block.speeches:
            if isinstance(behavior.does, Text) and behavior.id not in waiting.parts:
                order = Order(script_of_speech(behavior.does))
                waiting.missing += 1
                self._orders.append((order, waiting, behavior.id))
                self._synthesizer.ask(order)
        if block.speeches:
            self._face.talker  # noqa: B018  # made now, so that it is stepped with the face from here on
        self._waiting.append(waiting)
        return waiting.doing

    def wait(self) -> None:
        """Until everything is spoken that blocks say: nothing is late then, however the face is stepped."""
        self._synthesizer.wait()

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass, at most ``due_s`` for what is then to be in its time; 0 begins what is ready."""
        self._now += dt
        while (done := self._synthesizer.take()) is not None:
            self._take(done)
        for run in [run for run in self._runs if run.doing.outcome is not None]:
            self._take_back(run)
        while True:
            while self._events and self._events[0][0] <= self._now + _SAME_S:
                *_, run, happens = heappop(self._events)
                if not run.over:
                    happens()
            ready = next(self._ready(), None)
            if ready is None:
                return
            self._begin(ready)

    def stop(self, fade: float | None = None) -> None:
        """End what plays within ``fade`` seconds, and drop what waits; the usual time when None."""
        self._drop(tuple(self._waiting))
        self._synthesizer.drop()
        self._stop_runs(bml_table().let_go_s if fade is None else fade)

    def notice(self, request: Request) -> None:
        """End all when the face is told to let go; what tells it what to feel outlasts what plays."""
        if self._own:
            return
        if isinstance(request, Neutral):
            self._staging.forget()
            self.stop(request.fade)
        elif isinstance(request, SetEmotion):
            self._staging.felt(request.emotion, request.intensity)
        elif isinstance(request, SetEmotions):
            for name, level in request.state.items():
                self._staging.felt(name, level)

    def close(self) -> None:
        """End the voices."""
        self._synthesizer.close()

    def _take(self, done: Done) -> None:
        place = next((place for place, each in enumerate(self._orders) if each[0] is done.order), None)
        if place is None:
            return
        _, waiting, behavior = self._orders[place]
        if done.error is not None:
            self._fail(waiting, done.error)
            return
        if done.spoken is not None:
            waiting.parts.setdefault(behavior, []).append(done.spoken)
        if done.last:
            del self._orders[place]
            waiting.missing -= 1

    def _fail(self, waiting: _Waiting, error: AgentFaceError) -> None:
        self._waiting.remove(waiting)
        self._orders = [each for each in self._orders if each[1] is not waiting]
        self.error = waiting.doing.error = error
        waiting.doing.end(whole=False)
        for tell in tuple(self.failed):
            tell(waiting.block.id, error)

    def _ready(self) -> Iterator[_Waiting]:
        """Those that may begin now; what was taken back while it waited never does."""
        self._drop([waiting for waiting in self._waiting if waiting.doing.outcome is not None])
        for place, waiting in enumerate(self._waiting):
            turn = waiting.block.composition != "APPEND" or (place == 0 and not self._runs)
            if turn and not waiting.missing:
                yield waiting

    def _begin(self, waiting: _Waiting) -> None:
        block = waiting.block
        early = self._face.talker.latency_s if block.speeches else 0.0
        start = self._now + early
        try:
            spoken = performed(block, {name: joined(parts) for name, parts in waiting.parts.items()})
            steps = {name: each for name, (_, each) in spoken.items()}
            times = schedule(block, steps, partial(self._outside, start))
        except AgentFaceError as error:
            self._fail(waiting, error)
            return
        if block.composition == "REPLACE":
            self._drop(self._waiting[: self._waiting.index(waiting)])
            self._stop_runs(bml_table().let_go_s)
        self._waiting.remove(waiting)
        waiting.doing.begun = True
        run = _Run(block, waiting.doing, start, times)
        self._runs.append(run)
        self._remember(run)
        self._at(run, 0.0, partial(self._tell, run, STARTS))
        for behavior in block.behaviors:
            self._plan(run, behavior, {name: each for name, (each, _) in spoken.items()}, early)
        self._at(run, times.end_s, partial(self._end, run))

    def _outside(self, start: float, point: SyncPoint) -> float | None:
        run = self._over.get(point.block)
        if run is None:
            return None
        if not point.behavior:
            time: float | None = 0.0 if point.name == STARTS else run.times.end_s
        else:
            time = run.times.times.get(SyncPoint(point.behavior, point.name))
        return None if time is None else run.start + time - start

    def _remember(self, run: _Run) -> None:
        self._over.pop(run.block.id, None)
        self._over[run.block.id] = run
        while len(self._over) > _MOST_OVER:
            del self._over[next(iter(self._over))]

    def _plan(self, run: _Run, behavior: Behavior, spoken: Mapping[str, Spoken], early: float) -> None:
        """Have everything that a behavior does happen in its time; it is told to speak ``early`` by so much."""
        times = run.times.of(behavior)
        acts = dict(self._acts(run, behavior, times))
        for name, time in zip(behavior.points, times, strict=True):
            if isinstance(behavior.does, Text) and name == STARTS:
                lead = min(LEAD_S, time)
                self._at(run, time - early - lead, partial(self._say_soon, run, spoken[behavior.id], lead))
                self._at(run, time - early, partial(self._say, run, spoken[behavior.id]))
            elif name in acts:
                self._at(run, time, acts[name])
            if isinstance(behavior.does, Nod) and name == STARTS:
                self._plan_nods(run, behavior, behavior.does, times[0], times[-1] - times[0])
            if behavior.kind != "other":
                self._at(run, time, partial(self._tell, run, f"{behavior.id}:{name}"))

    def _acts(self, run: _Run, behavior: Behavior, times: Sequence[float]) -> Iterator[tuple[str, Callable[[], None]]]:
        """What is done at which sync point."""
        does, staging, owner = behavior.does, self._staging, (run, behavior.id)
        fades = [later - earlier for earlier, later in pairwise(times)]
        if isinstance(does, Text):
            yield ENDS, partial(setattr, run, "speaking", False)
        elif isinstance(does, Aim):
            if behavior.kind == "gaze":
                yield STARTS, partial(staging.look, owner, does, fades[0])
                yield "relax", partial(staging.look_back, owner, fades[-1])
            else:
                shift = staging.shift_look if behavior.kind == "gaze_shift" else staging.shift_head
                yield STARTS, partial(shift, does, fades[0])
        elif isinstance(does, Nod):
            yield ENDS, partial(staging.nodded, owner)
        elif does is not None and behavior.kind == "face":
            yield STARTS, partial(staging.show, owner, does, fades[0])
            yield "relax", partial(staging.let_go, owner, fades[-1])
        elif does is not None:
            yield STARTS, partial(staging.shift, does, fades[0])

    def _plan_nods(self, run: _Run, behavior: Behavior, nod: Nod, start: float, length: float) -> None:
        each = length / nod.times
        for number in range(nod.times):
            self._at(run, start + number * each, partial(self._staging.nod, (run, behavior.id), nod, each))

    def _say_soon(self, run: _Run, spoken: Spoken, in_s: float) -> None:
        """Have the mouth round for a speech before it begins, unless that would end what is said until then."""
        if not self._face.talker.busy:
            run.told_early = spoken
            self._perform(run, spoken, in_s)

    def _say(self, run: _Run, spoken: Spoken) -> None:
        if run.told_early is not spoken:
            self._perform(run, spoken, 0.0)

    def _perform(self, run: _Run, spoken: Spoken, in_s: float) -> None:
        run.speaking = True
        self._face.talker.perform(spoken, interrupt=True, in_s=in_s)

    def _end(self, run: _Run) -> None:
        run.over = True
        run.doing.end(whole=True)
        self._runs.remove(run)
        self._tell(run, ENDS)

    def _drop(self, dropped: Sequence[_Waiting]) -> None:
        """Forget blocks that wait."""
        for waiting in dropped:
            self._waiting.remove(waiting)
            self._orders = [each for each in self._orders if each[1] is not waiting]
            waiting.doing.end(whole=False)
            self._tell_all(Progress(waiting.block.id, STOPPED, 0.0))

    def _take_back(self, run: _Run) -> None:
        """End one block that somebody no longer wants."""
        fade = bml_table().let_go_s
        self._runs.remove(run)
        run.over = True
        for behavior in run.block.behaviors:
            self._staging.let_go((run, behavior.id), fade)
            self._staging.look_back((run, behavior.id), fade)
            self._staging.end_nod((run, behavior.id))
        if run.speaking:
            self._ask(Hush())
        self._tell(run, STOPPED)

    def _stop_runs(self, fade: float) -> None:
        runs, self._runs = self._runs, []
        if not runs:
            return
        self._staging.clear(fade)
        if any(run.speaking for run in runs):
            self._ask(Hush())
        for run in runs:
            run.over = True
            run.doing.end(whole=False)
            self._tell(run, STOPPED)

    def _at(self, run: _Run, time: float, happens: Callable[[], None]) -> None:
        heappush(self._events, (run.start + time, next(self._count), run, happens))

    def _tell(self, run: _Run, what: str) -> None:
        self._tell_all(Progress(run.block.id, what, max(self._now - run.start, 0.0)))

    def _tell_all(self, progress: Progress) -> None:
        for tell in tuple(self.told):
            tell(progress)

    def _ask(self, request: Request) -> None:
        self._own = True
        try:
            self._face.apply(request)
        finally:
            self._own = False
