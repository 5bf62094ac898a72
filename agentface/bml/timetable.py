"""When each sync point of a block is: what the document says, and for the rest what is usual."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

from agentface.bml.block import ENDS, STARTS, Behavior, Block, Meeting, Precedence, SyncPoint, SyncTime
from agentface.bml.order import Outside, check_order
from agentface.errors import DataError, Fault

SAME_S = 1e-6
"""Times that differ by no more are the same."""


@dataclass(frozen=True, slots=True)
class Timetable:
    """Seconds after the start of a block, by sync point; ``end_s`` is the last of them."""

    times: Mapping[SyncPoint, float]

    @property
    def end_s(self) -> float:
        """When all is over."""
        return max(self.times.values(), default=0.0)

    def of(self, behavior: Behavior) -> list[float]:
        """The times of a behavior's sync points in their order."""
        return [self.times[SyncPoint(behavior.id, name)] for name in behavior.points]


def schedule(
    block: Block, spoken: Mapping[str, Sequence[float]] | None = None, outside: Outside = lambda _: None
) -> Timetable:
    """When each sync point of ``block`` is.

    What no anchor and no constraint says is placed by what is usual: a behavior that says nothing starts with the
    block; one that says one time has the others as far from it as usual; between two the usual times are stretched.
    Nothing is before the block's start.

    Args:
        block: as it is read.
        spoken: by the id of a speech, the seconds from each of its sync points to the next, which nothing changes.
        outside: tells the times of other blocks.

    Raises DataError, each fault with its line: a circle, sync points against their order, a speech while another one
    is said, a sync point of a block that is not known.
    """
    told = [_resolved(block, behavior.line, anchor, outside) for behavior, anchor in _anchors(block)]
    faults = [item for item in told if isinstance(item, Fault)]
    if faults:
        raise DataError(faults)
    check_order(block, spoken or {}, outside)
    placed = _Placing(block, spoken or {}, outside).all()
    faults = _broken(block, placed, outside)
    if faults:
        raise DataError(faults)
    return Timetable(placed)


def time_of(anchor: SyncTime, times: Mapping[SyncPoint, float], outside: Outside) -> float | None:
    """When an anchor is, as far as that is known."""
    point = anchor.point
    known = outside(point) if point.block else 0.0 if not point.behavior else times.get(point)
    return None if known is None else known + anchor.offset_s


def _anchors(block: Block) -> list[tuple[Behavior | Precedence | Meeting, SyncTime]]:
    own = [(behavior, anchor) for behavior in block.behaviors for _, anchor in behavior.anchors]
    orders = [(order, anchor) for order in block.orders for anchor in (order.earlier, order.later)]
    return [*own, *orders, *((meeting, anchor) for meeting in block.meetings for anchor in meeting.points)]


def _resolved(block: Block, line: int, anchor: SyncTime, outside: Outside) -> Fault | None:
    point = anchor.point
    if not point.block or outside(point) is not None:
        return None
    return Fault(block.path, line, str(point), "a sync point of a block that plays or has played", "an unknown one")


class _Placing:
    """Places the behaviors of one block one after the other, each when what it waits for is known."""

    def __init__(self, block: Block, spoken: Mapping[str, Sequence[float]], outside: Outside) -> None:
        self._block, self._spoken, self._outside = block, spoken, outside
        self._times: dict[SyncPoint, float] = {}
        self._same: dict[SyncPoint, list[SyncTime]] = defaultdict(list)
        self._waits: dict[str, list[SyncPoint]] = defaultdict(list)
        self._least: dict[SyncPoint, list[SyncTime]] = defaultdict(list)
        self._most: dict[SyncPoint, list[SyncTime]] = defaultdict(list)
        for behavior in block.behaviors:
            for name, anchor in behavior.anchors:
                self._tie(SyncPoint(behavior.id, name), anchor)
        for meeting in block.meetings:
            self._meet(meeting)
        for order in block.orders:
            earlier, later = order.earlier, order.later
            self._bound(self._least, later, earlier)
            self._bound(self._most, earlier, later)
            first, second = (later, earlier) if order.before else (earlier, later)
            self._waits[second.point.behavior].append(first.point)

    def all(self) -> dict[SyncPoint, float]:
        """Seconds after the start of the block."""
        waiting = list(self._block.behaviors)
        while waiting:
            behavior = next((each for each in waiting if self._is_ready(each)), None)
            behavior = behavior or next((each for each in waiting if self._known(each)), waiting[0])
            waiting.remove(behavior)
            self._place(behavior)
        return self._times

    def _tie(self, point: SyncPoint, anchor: SyncTime) -> None:
        """Have ``point`` be at ``anchor``, and wait for it."""
        self._same[point].append(anchor)
        self._same[anchor.point].append(SyncTime(point, -anchor.offset_s))
        self._waits[point.behavior].append(anchor.point)

    def _meet(self, meeting: Meeting) -> None:
        """A speech leads, whose times are its own; else what is named first."""
        points = sorted(meeting.points, key=lambda anchor: anchor.point.behavior not in self._spoken)
        for anchor in points[1:]:
            self._tie(anchor.point, SyncTime(points[0].point, points[0].offset_s - anchor.offset_s))

    @staticmethod
    def _bound(bounds: dict[SyncPoint, list[SyncTime]], bound: SyncTime, by: SyncTime) -> None:
        bounds[bound.point].append(SyncTime(by.point, by.offset_s - bound.offset_s))

    def _is_ready(self, behavior: Behavior) -> bool:
        return all(
            time_of(SyncTime(point), self._times, self._outside) is not None
            for point in self._waits[behavior.id]
            if point.behavior != behavior.id
        )

    def _known(self, behavior: Behavior) -> dict[int, float]:
        """The times of its sync points that are known already, by their places."""
        found = {}
        for place, name in enumerate(behavior.points):
            for anchor in (SyncTime(SyncPoint(behavior.id, name)), *self._same[SyncPoint(behavior.id, name)]):
                time = time_of(anchor, self._times, self._outside)
                if time is not None:
                    found[place] = time
                    break
        return found

    def _place(self, behavior: Behavior) -> None:
        known, points = self._known(behavior), [SyncPoint(behavior.id, name) for name in behavior.points]
        rigid = self._spoken.get(behavior.id)
        times = _filled(behavior, known, rigid)
        if not known:
            known[0] = max(0.0, *(self._over(point, time) for point, time in zip(points, times, strict=True)))
            times = _filled(behavior, known, rigid)
        for place, point in enumerate(points if rigid is None else ()):
            over = self._over(point, times[place])
            if place not in known and abs(over) > SAME_S:  # pushed to its bound, and the others made to fit
                known[place] = times[place] + over
                times = _filled(behavior, known, None)
        self._times |= zip(points, times, strict=True)

    def _over(self, point: SyncPoint, time: float) -> float:
        """By how much ``time`` is too early, negative where it is too late."""
        least = [time_of(anchor, self._times, self._outside) for anchor in self._least[point]]
        most = [time_of(anchor, self._times, self._outside) for anchor in self._most[point]]
        early = max((bound - time for bound in least if bound is not None), default=0.0)
        late = min((bound - time for bound in most if bound is not None), default=0.0)
        return max(early, 0.0) or min(late, 0.0)


def _filled(behavior: Behavior, known: Mapping[int, float], rigid: Sequence[float] | None) -> list[float]:
    """All times of a behavior of which some are known by their places: the others by the usual steps between.

    Between two that are known, what is more than usual goes where the behavior holds, if it does; else all is
    stretched. ``rigid`` are steps that nothing changes.
    """
    steps = rigid or behavior.usual_s
    usual = [sum(steps[:place]) for place in range(len(steps) + 1)]
    if not known:
        return usual
    first, last = min(known), max(known)
    if rigid is not None:
        return [known[first] + time - usual[first] for time in usual]
    times = []
    for place, time in enumerate(usual):
        if place < first:  # not before the block's start
            room = min(usual[first], max(known[first], 0.0))
            times.append(known[first] - room + (room * time / usual[first] if usual[first] else 0.0))
        elif place > last:
            times.append(known[last] + time - usual[last])
        else:
            low = max(each for each in known if each <= place)
            high = min(each for each in known if each >= place)
            times.append(_between(usual[low : high + 1], place - low, (known[low], known[high]), behavior.holds, low))
    return times


def _between(usual: list[float], place: int, ends: tuple[float, float], holds: int | None, low: int) -> float:
    usually, has = usual[-1] - usual[0], ends[1] - ends[0]
    since = usual[place] - usual[0]
    if holds is not None and 0 <= holds - low < len(usual) - 1 and has > usually:
        return ends[0] + since + (has - usually if place > holds - low else 0.0)
    return ends[0] + (has * since / usually if usually else 0.0)


def _broken(block: Block, times: Mapping[SyncPoint, float], outside: Outside) -> list[Fault]:
    """What is not as the document says."""
    found = [_out_of_order(block, behavior, times) for behavior in block.behaviors]
    faults = [fault for fault in found if fault is not None]
    for behavior in block.behaviors:
        for name, at in behavior.anchors:
            wanted, is_at = time_of(at, times, outside), times[SyncPoint(behavior.id, name)]
            if wanted is not None and abs(wanted - is_at) > SAME_S:
                expected = f"{name} at {at.point}, {wanted:.3f} s"
                faults.append(Fault(block.path, behavior.line, behavior.id, expected, f"{is_at:.3f} s"))
    return [*faults, *_broken_constraints(block, times, outside), *_overlapping(block, times)]


def _out_of_order(block: Block, behavior: Behavior, times: Mapping[SyncPoint, float]) -> Fault | None:
    own = [(times[SyncPoint(behavior.id, name)], name) for name in behavior.points]
    for (before, first), (after, second) in pairwise([(0.0, "the block's start"), *own]):
        if after < before - SAME_S:
            expected = f"{second} not before {first}, at {before:.3f} s"
            return Fault(block.path, behavior.line, behavior.id, expected, f"{after:.3f} s")
    return None


def _broken_constraints(block: Block, times: Mapping[SyncPoint, float], outside: Outside) -> Iterator[Fault]:
    for order in block.orders:
        earlier, later = time_of(order.earlier, times, outside), time_of(order.later, times, outside)
        if earlier is not None and later is not None and later < earlier - SAME_S:
            expected = f"{order.later.point} not before {order.earlier.point}, at {earlier:.3f} s"
            yield Fault(block.path, order.line, "constraint", expected, f"{later:.3f} s")
    for meeting in block.meetings:
        met = [time for at in meeting.points if (time := time_of(at, times, outside)) is not None]
        if met and max(met) - min(met) > SAME_S:
            got = f"{min(met):.3f} s and {max(met):.3f} s"
            yield Fault(block.path, meeting.line, "constraint", "the same time", got)


def _overlapping(block: Block, times: Mapping[SyncPoint, float]) -> Iterator[Fault]:
    """Speeches that begin while another one is said: there is one mouth."""
    speeches = sorted(block.speeches, key=lambda speech: times[SyncPoint(speech.id, STARTS)])
    for one, other in pairwise(speeches):
        end, start = times[SyncPoint(one.id, ENDS)], times[SyncPoint(other.id, STARTS)]
        if start < end - SAME_S:
            expected = f"a start not before the end of {one.id}, at {end:.3f} s"
            yield Fault(block.path, other.line, other.id, expected, f"{start:.3f} s")
