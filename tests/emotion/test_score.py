from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.score import FADE_S, LONGEST_S, Cue, Score
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.motion.envelope import Envelope

FRACTIONS = st.floats(0.0, 1.0)


@st.composite
def cues(draw):
    start = draw(st.floats(0.0, 20.0))
    samples = tuple(draw(st.lists(FRACTIONS, min_size=1, max_size=6)))
    rate = draw(st.floats(0.5, 200.0)) if len(samples) > 1 else 0.0
    return Cue(draw(st.sampled_from(EMOTIONS)), start, start + draw(st.floats(0.01, 5.0)), samples, rate)


def by_hand(shown, time):
    """The state by another method: numpy's interpolation, cue by cue."""
    levels = dict.fromkeys(EMOTIONS, 0.0)
    for cue in shown:
        if cue.start_s <= time < cue.end_s:
            times = cue.start_s + np.arange(len(cue.samples)) / (cue.rate_hz or 1.0)
            levels[cue.emotion] = max(levels[cue.emotion], float(np.interp(time, times, cue.samples)))
    return [levels[emotion] for emotion in EMOTIONS]


@given(st.lists(cues(), max_size=8), st.floats(-1.0, 30.0))
def test_the_state_is_the_largest_of_each_emotion(shown, time):
    state = Score(shown).state(time)
    assert state.array == pytest.approx(by_hand(shown, time), abs=1e-9)
    assert ((state.array >= 0.0) & (state.array <= 1.0)).all()


@given(st.lists(cues(), max_size=8))
def test_changes_are_in_order_and_end_neutral(shown):
    score = Score(shown)
    times = [change.time_s for change in score.changes]
    assert times[0] == 0.0
    assert all(before < after for before, after in pairwise(times))
    assert times[-1] <= score.duration_s
    assert score.changes[-1].state == EmotionState()
    assert all(0.0 < change.fade_s <= FADE_S for change in score.changes)
    assert score.length_s == (score.duration_s + FADE_S if shown else 0.0)


@given(st.lists(cues(), max_size=5), st.floats(-1.0, 30.0))
def test_the_change_at_a_time_is_the_last_one_before_it(shown, time):
    score = Score(shown)
    expected = [change for change in score.changes if change.time_s <= time] or [score.changes[0]]
    assert score.change(time) is expected[-1]


@given(st.lists(cues().filter(lambda cue: len(cue.samples) == 1), max_size=8))
def test_constant_cues_change_to_the_state_of_their_time(shown):
    score = Score(shown)
    for change in score.changes:
        assert change.state == score.state(change.time_s)


def test_constant_cues_one_after_the_other():
    score = Score([Cue("fear", 2.0, 2.1), Cue("anger", 0.5, 2.0, (0.5,))])
    assert [cue.emotion for cue in score.cues] == ["anger", "fear"]
    assert [(change.time_s, change.state) for change in score.changes] == [
        (0.0, EmotionState()),
        (0.5, EmotionState.of(anger=0.5)),
        (2.0, EmotionState.of(fear=1.0)),
        (2.1, EmotionState()),
    ]
    assert [change.fade_s for change in score.changes] == pytest.approx([0.25, 0.25, 0.1, 0.25])


@pytest.mark.parametrize("rate", [2.0, 10.0, 50.0])
def test_a_face_that_is_told_the_changes_follows_a_trace(rate):
    samples = tuple(0.5 - 0.4 * np.cos(2.0 * np.pi * np.arange(int(6 * rate)) / rate / 3.0))
    score = Score([Cue("happiness", 0.0, 6.0, samples, rate)])
    shown, told, apart, speeds = Envelope(len(EMOTIONS)), None, [], []
    for frame in range(5 * 60):
        change = score.change(frame / 60)
        if change is not told:
            shown.move(change.state.array, change.fade_s)
            told = change
        shown.advance(1 / 60)
        apart.append(abs(shown.value[0] - score.state((frame + 1) / 60)["happiness"]))
        speeds.append(shown.velocity[0])
    assert max(apart[15:]) < 0.04, "after the first quarter of a second"
    rising = speeds[20:80]  # the cosine's way up, without a halt at a sample
    assert min(rising) > 0.1


def test_many_overlapping_traces_are_no_more_changes_than_one():
    trace = Cue("fear", 0.0, 60.0, (0.0, 1.0), 1.0 / 60.0)
    assert len(Score([trace] * 500).changes) == len(Score([trace]).changes) < 21 * 60


def test_no_cues_are_a_neutral_face():
    score = Score()
    assert score.state(1.0) == score.changes[0].state == EmotionState()
    assert (score.duration_s, score.length_s, len(score.changes)) == (0.0, 0.0, 1)


@pytest.mark.parametrize(
    ("arguments", "what"),
    [
        (("joy", 0.0, 1.0), "happiness"),
        (("fear", -1.0, 1.0), "start_s"),
        (("fear", 1.0, 1.0), "end_s"),
        (("fear", 0.0, LONGEST_S + 1.0), "end_s"),
        (("fear", 0.0, float("nan")), "end_s"),
        (("fear", 0.0, 1.0, ()), "samples"),
        (("fear", 0.0, 1.0, (1.5,)), "sample"),
        (("fear", 0.0, 1.0, (0.0, 1.0)), "rate_hz"),
        (("fear", 0.0, 1.0, (0.0, 1.0), 1e9), "rate_hz"),
    ],
)
def test_a_cue_says_what_is_wrong(arguments, what):
    with pytest.raises(InvalidValueError, match=what):
        Cue(*arguments)


def test_a_cue_needs_an_emotion():
    with pytest.raises(UnknownNameError):
        Cue("boredom", 0.0, 1.0)
