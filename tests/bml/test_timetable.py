from __future__ import annotations

import itertools

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.bml.block import POINTS, Behavior, Block, Meeting, Precedence, SyncPoint, SyncTime, Text
from agentface.bml.table import bml_table
from agentface.bml.timetable import schedule
from agentface.errors import DataError


def usual(kind, behavior="a", **anchors):
    """A behavior of usual length; anchors are seconds, or (behavior, sync, offset)."""

    def at(value):
        if isinstance(value, tuple):
            return SyncTime(SyncPoint(*value[:2]), value[2] if len(value) > 2 else 0.0)
        return SyncTime(SyncPoint(), value)

    steps = bml_table().usual_s.get(kind, (0.1,) * (len(POINTS[kind]) - 1))
    return Behavior(behavior, kind, 1, None, steps, tuple((name, at(value)) for name, value in anchors.items()))


def times(*behaviors, **constraints):
    table = schedule(Block("b", behaviors, **constraints)).times
    return {f"{point.behavior}:{point.name}": time for point, time in table.items()}


def test_what_says_nothing_starts_with_the_block_and_takes_its_usual_time():
    found = times(usual("face"), usual("gaze", "g"))
    steps = bml_table().usual_s["face"]
    assert list(found.values())[:4] == pytest.approx([0.0, *itertools.accumulate(steps)])
    assert found["g:start"] == 0.0


@pytest.mark.parametrize("name", POINTS["head"])
def test_one_time_moves_all_of_a_behavior(name):
    free, told = times(usual("head")), times(usual("head", **{name: 5.0}))
    assert [told[point] - 5.0 for point in free] == pytest.approx([time - free[f"a:{name}"] for time in free.values()])
    assert told[f"a:{name}"] == 5.0


def test_between_two_times_a_head_is_stretched_and_a_face_holds_longer():
    head, free = times(usual("head", start=1.0, end=4.0)), times(usual("head"))
    for name in POINTS["head"]:
        assert head[f"a:{name}"] == pytest.approx(1.0 + 3.0 * free[f"a:{name}"] / free["a:end"])
    face, free = times(usual("face", start=1.0, end=21.0)), times(usual("face"))
    assert face["a:attackPeak"] - 1.0 == pytest.approx(free["a:attackPeak"])
    assert 21.0 - face["a:relax"] == pytest.approx(free["a:end"] - free["a:relax"])


def test_what_is_too_early_for_its_attack_attacks_faster():
    found = times(usual("face", attackPeak=0.1))
    assert found["a:start"] == 0.0
    assert found["a:attackPeak"] == pytest.approx(0.1)


def test_a_chain_of_references_in_any_order():
    chain = [usual("wait", "a"), usual("wait", "b", start=("a", "end", 0.5)), usual("wait", "c", end=("b", "start"))]
    for order in itertools.permutations(chain):
        found = times(*order)
        assert found["b:start"] == found["a:end"] + 0.5
        assert found["c:end"] == found["b:start"]


def test_both_ends_from_two_behaviors():
    found = times(
        usual("face", "f", start=("a", "end"), end=("b", "end", 0.25)),
        usual("wait", "a"),
        usual("wait", "b", start=3.0),
    )
    assert (found["f:start"], found["f:end"]) == (1.0, 4.25)


def at(behavior, name, offset=0.0):
    return SyncTime(SyncPoint(behavior, name), offset)


def test_after_moves_what_is_free_and_before_hurries_it():
    late = Precedence(at("w", "end"), at("a", "attackPeak"), 7)
    found = times(usual("face"), usual("wait", "w", start=2.0), orders=(late,))
    assert found["a:attackPeak"] == pytest.approx(found["w:end"])
    early = Precedence(at("a", "relax"), at("w", "start"), 7, before=True)
    found = times(usual("face"), usual("wait", "w", start=0.6), orders=(early,))
    assert found["a:relax"] == pytest.approx(0.6)
    assert 0.0 <= found["a:attackPeak"] <= 0.6


def test_sync_points_meet_where_the_speech_is():
    speech = Behavior("s", "speech", 1, Text(("a", "b"), ("word",)), (0.0, 0.0))
    meeting = Meeting((at("h", "stroke"), at("s", "word", 0.1)), 3)
    for behaviors in itertools.permutations((usual("head", "h"), speech)):
        table = schedule(Block("b", behaviors, meetings=(meeting,)), {"s": (1.5, 0.5)}).times
        assert table[SyncPoint("s", "start")] == 0.0
        assert table[SyncPoint("h", "stroke")] == pytest.approx(1.6)


def fault(*behaviors, spoken=None, **constraints):
    with pytest.raises(DataError) as caught:
        schedule(Block("b", behaviors, **constraints), spoken)
    return "\n".join(map(str, caught.value.faults))


def test_circles_and_impossible_orders_are_told():
    ring = usual("wait", "a", start=("b", "end")), usual("face", "b", start=("a", "end"))
    assert "circle" in fault(*ring)
    assert "circle" in fault(usual("face", start=("a", "end", 1.0)))
    assert "circle" in fault(usual("face", start=2.0, end=1.0))
    assert "circle" in fault(usual("face", start=1.0, end=1.0)), "nothing is shown for no time"
    both = Precedence(at("a", "end"), at("b", "start"), 7), Precedence(at("b", "start"), at("a", "start"), 8)
    assert "block.bml:1" in fault(usual("face"), usual("face", "b"), orders=both)
    speech = Behavior("s", "speech", 4, Text(("a",)), (0.0,), (("start", SyncTime(SyncPoint(), 1.0)),))
    again = Behavior("t", "speech", 5, Text(("a",)), (0.0,), (("start", SyncTime(SyncPoint(), 1.5)),))
    assert "block.bml:5: t: expected a start not before the end of s" in fault(
        speech, again, spoken={"s": (1.0,), "t": (1.0,)}
    )


def test_a_speech_s_own_times_stay():
    speech = Behavior(
        "s", "speech", 4, Text(("a",)), (0.0,), (("start", SyncTime(SyncPoint(), 1.0)), ("end", at("w", "end")))
    )
    assert "circle" in fault(speech, usual("wait", "w", start=5.0, end=9.0), spoken={"s": (2.0,)})


def test_other_blocks_are_where_somebody_says():
    behavior = usual("face", start=("x", "end", 0.5))
    told = Behavior("a", "face", 3, None, behavior.usual_s, (("start", SyncTime(SyncPoint("x", "end", "o"), 0.5)),))
    assert (
        schedule(Block("b", (told,)), outside={SyncPoint("x", "end", "o"): 2.0}.get).times[SyncPoint("a", "start")]
        == 2.5
    )
    assert "block.bml:3: o:x:end" in fault(told)
    with pytest.raises(DataError):  # it is over, and nothing starts before its block
        schedule(Block("b", (told,)), outside=lambda _: -2.0)


NAMES = ("a", "b", "c", "d")
KINDS = st.sampled_from(("face", "gaze", "head", "wait", "gaze_shift", "face_shift"))


@st.composite
def blocks(draw):
    kinds = {name: draw(KINDS) for name in NAMES[: draw(st.integers(1, 4))]}
    any_point = st.sampled_from([(name, point) for name, kind in kinds.items() for point in POINTS[kind]])
    offsets = st.floats(-1, 3).map(lambda value: round(value, 2))
    moment = st.one_of(st.floats(0, 5), st.tuples(any_point, offsets).map(lambda each: (*each[0], each[1])))
    behaviors = [
        usual(kind, name, **draw(st.dictionaries(st.sampled_from(POINTS[kind]), moment, max_size=2)))
        for name, kind in kinds.items()
    ]
    anchors = st.builds(SyncTime, any_point.map(lambda each: SyncPoint(*each)), offsets)
    orders = draw(st.lists(st.builds(Precedence, anchors, anchors, st.just(1), st.booleans()), max_size=2))
    meetings = draw(st.lists(st.builds(lambda *met: Meeting(met, 1), anchors, anchors), max_size=1))
    return Block("b", tuple(behaviors), orders=tuple(orders), meetings=tuple(meetings))


@given(blocks())
def test_what_is_scheduled_is_as_it_is_told(block):
    """The rules by hand: nothing early, all in order, what is told where it is told; or a fault with its line."""
    try:
        found = schedule(block).times
    except DataError as error:
        found, faults = {}, error.faults
    if not found:
        assert {each.line for each in faults} == {1}
        return

    def time(anchor):
        return anchor.offset_s + (found[anchor.point] if anchor.point.behavior else 0.0)

    for behavior in block.behaviors:
        own = [found[SyncPoint(behavior.id, name)] for name in behavior.points]
        assert own[0] > -1e-5
        assert all(later >= earlier - 1e-5 for earlier, later in itertools.pairwise(own))
        for name, anchor in behavior.anchors:
            assert found[SyncPoint(behavior.id, name)] == pytest.approx(time(anchor), abs=1e-5)
    for order in block.orders:
        assert time(order.later) >= time(order.earlier) - 1e-5
    for meeting in block.meetings:
        assert time(meeting.points[0]) == pytest.approx(time(meeting.points[1]), abs=1e-5)
