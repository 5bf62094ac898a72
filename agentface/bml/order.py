"""Whether the sync points of a block can be in their order at all: circles of them cannot."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import pairwise
from typing import TypeAlias

from agentface.bml.block import Behavior, Block, SyncPoint, SyncTime
from agentface.errors import DataError, Fault

SHORTEST_S = 0.02
"""No behavior that begins and ends is shorter."""
_Rule: TypeAlias = tuple[SyncPoint, SyncPoint, float, int]
"""That the second is at least so many seconds after the first, and the line that says so."""
Outside: TypeAlias = Callable[[SyncPoint], float | None]
"""When a sync point of another block is, in seconds after the start of this one; None where nobody knows it."""
_ROUNDING_S = 1e-9


def check_order(
    block: Block,
    spoken: Mapping[str, Sequence[float]] | None = None,
    outside: Outside = lambda _: None,
) -> None:
    """Raise DataError where sync points wait for themselves, or are told to be where their order does not allow.

    Least times are summed up along what waits for what, round by round, until they stay (Bellman, Quarterly of Applied
    Mathematics 16, 1958): in a circle they grow for ever, and where each came from leads back to itself (Cherkassky,
    Goldberg, Mathematical Programming 85, 1999).
    """
    rules = _rules(block, spoken or {}, outside)
    least: dict[SyncPoint, float] = dict.fromkeys((point for rule in rules for point in rule[:2]), 0.0)
    came: dict[SyncPoint, _Rule] = {}
    changed = True
    while changed:
        changed = False
        for rule in rules:
            before, after, gap, _line = rule
            if least[after] < least[before] + gap - _ROUNDING_S:
                least[after], came[after], changed = least[before] + gap, rule, True
        circle = _circle(came)
        if circle:
            raise DataError([_told(block, circle)])


def _circle(came: Mapping[SyncPoint, _Rule]) -> list[_Rule]:
    """The rules of a circle, if some point came from itself."""
    seen: dict[SyncPoint, SyncPoint] = {}
    for first in came:
        point = first
        while point in came and point not in seen:
            seen[point] = first
            point = came[point][0]
        if seen.get(point) == first:
            circle = [came[point]]
            while circle[-1][0] != point:
                circle.append(came[circle[-1][0]])
            return circle[::-1]
    return []


def _told(block: Block, circle: Sequence[_Rule]) -> Fault:
    names = ", ".join(dict.fromkeys(str(rule[1]) for rule in circle))
    line = min(rule[3] for rule in circle)
    return Fault(block.path, line, "", "sync points that can be in their order", f"a circle: {names}"[:300])


def _rules(block: Block, spoken: Mapping[str, Sequence[float]], outside: Outside) -> list[_Rule]:
    told: list[tuple[SyncTime, SyncTime, int]] = []
    for behavior in block.behaviors:
        line = behavior.line
        told += [(SyncTime(SyncPoint(behavior.id, name)), at, line) for name, at in behavior.anchors]
    for meeting in block.meetings:
        told += [(meeting.points[0], at, meeting.line) for at in meeting.points[1:]]
    later = [*told, *((other, one, line) for one, other, line in told)]
    later += [(order.earlier, order.later, order.line) for order in block.orders]
    rules = [rule for behavior in block.behaviors for rule in _own_rules(behavior, spoken.get(behavior.id))]
    for first, second, line in later:
        one, other = _inside(first, outside), _inside(second, outside)
        if one is not None and other is not None:
            rules.append((one.point, other.point, one.offset_s - other.offset_s, line))
    return rules


def _own_rules(behavior: Behavior, spoken: Sequence[float] | None) -> Iterator[_Rule]:
    """What a behavior's own sync points say: they are in their order, and those of what is spoken in their time."""
    points, line = [SyncPoint(behavior.id, name) for name in behavior.points], behavior.line
    yield SyncPoint(), points[0], 0.0, line
    for place, (before, after) in enumerate(pairwise(points)):
        yield before, after, 0.0 if spoken is None else spoken[place], line
        if spoken is not None:
            yield after, before, -spoken[place], line
    if not behavior.kind.endswith("shift") and behavior.kind != "wait":
        yield points[0], points[-1], SHORTEST_S, line


def _inside(at: SyncTime, outside: Outside) -> SyncTime | None:
    """The same from the start of this block; None for what nobody knows."""
    if not at.point.block:
        return at
    time = outside(at.point)
    return None if time is None else SyncTime(SyncPoint(), time + at.offset_s)
