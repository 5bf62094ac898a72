from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays
from scipy.interpolate import PchipInterpolator

from agentface.errors import InvalidValueError
from agentface.motion.performance import LET_GO_S, LONGEST_S, Performance, rate_of
from agentface.parameters import COUNT, HIGH, LOW, NAMES

ALL = np.ones((1, COUNT), np.float32)


def poses_of(numbers):
    """Numbers in 0..1 spread over the range of every parameter."""
    return (LOW + np.asarray(numbers, np.float32)[:, None] * (HIGH - LOW)).clip(LOW, HIGH).astype(np.float32)


@st.composite
def performances(draw, least=1):
    steps = draw(st.lists(st.floats(0.001, 2.0), min_size=least - 1, max_size=9))
    times = np.cumsum([draw(st.floats(0, 3)), *steps])
    numbers = draw(arrays.arrays(np.float32, len(times), elements=st.floats(0, 1, width=32)))
    weights = ALL if draw(st.booleans()) else np.repeat(numbers[::-1, None], COUNT, 1)
    return Performance(times, poses_of(numbers), weights)


@given(performances())
def test_every_frame_is_hit_exactly(performance):
    values, weights = performance.sample(performance.times_s)
    np.testing.assert_array_equal(values.astype(np.float32), performance.poses)
    np.testing.assert_array_equal(weights.astype(np.float32), np.broadcast_to(performance.weights, values.shape))


@given(performances(), st.integers(1, 200), st.floats(1, 240))
def test_a_sum_of_frame_times_hits_the_frames_too(performance, frames, rate):
    summed = np.cumsum([0.0, *[1 / rate] * frames])
    regular = Performance.regular(rate, np.resize(performance.poses, (frames + 1, COUNT)), ALL)
    np.testing.assert_array_equal(regular.sample(summed)[0].astype(np.float32), regular.poses)


@given(performances(), st.lists(st.floats(-1, 25), min_size=1, max_size=20))
def test_nothing_overshoots_the_two_frames_that_it_is_between(performance, at):
    values, weights = performance.sample(at)
    places = np.clip(np.searchsorted(performance.times_s, at, side="right") - 1, 0, len(performance) - 1)
    after = np.minimum(places + 1, len(performance) - 1)
    weighed = np.broadcast_to(performance.weights, (len(performance), COUNT))
    for shown, rows in ((values, performance.poses), (weights, weighed)):
        low, high = np.minimum(rows[places], rows[after]), np.maximum(rows[places], rows[after])
        slack = 3e-6 * (1 + np.abs(high - low).max())  # of a time that is taken for a frame's
        assert (shown >= low - slack).all()
        assert (shown <= high + slack).all()


@given(performances(least=2), st.lists(st.floats(0, 1), min_size=1, max_size=20))
def test_scipys_monotone_cubic_says_the_same(performance, parts):
    times = performance.times_s
    at = times[0] + np.array(parts) * (times[-1] - times[0])
    at = at[np.abs(at[:, None] - times).min(axis=1) > 1e-5]
    expected = PchipInterpolator(times, performance.poses.astype(np.float64))(at)
    np.testing.assert_allclose(performance.sample(at)[0], expected, atol=1e-7)


@given(performances(least=3))
def test_the_speed_has_no_jump(performance):
    eps = 1e-5
    inner = performance.times_s[1:-1]
    at = np.stack([inner - 3 * eps, inner - 2 * eps, inner + 2 * eps, inner + 3 * eps])
    values = performance.sample(at)[0]
    before, after = (values[1] - values[0]) / eps, (values[3] - values[2]) / eps
    fastest = np.abs(np.diff(performance.poses, axis=0)).max() / np.diff(performance.times_s).min()
    bend = fastest / np.diff(performance.times_s).min()
    assert np.abs(after - before).max() <= 60 * bend * eps + 1e-4


def test_before_the_first_frame_and_after_the_last_it_stands_still():
    performance = Performance([1.0, 2.0], poses_of([0.25, 0.75]), ALL)
    for at, frame in ((-5.0, 0), (0.0, 0), (2.5, 1), (1e9, 1)):
        np.testing.assert_array_equal(performance.sample(at)[0].astype(np.float32), performance.poses[frame])


def test_one_frame_is_a_performance():
    performance = Performance([0.5], poses_of([0.5]), ALL)
    assert performance.sample([[0.0, 1.0, 2.0]])[0].shape == (1, 3, COUNT)
    assert (performance.duration_s, performance.length_s) == (0.5, 0.5 + LET_GO_S)


def test_it_says_what_it_moves_and_never_changes():
    weights = np.zeros((2, COUNT), np.float32)
    weights[1, 3] = 0.5
    given = poses_of([0, 1])
    performance = Performance([0, 1], given, weights, name="nod")
    assert performance.moved == (NAMES[3],)
    given[:] = weights[:] = 0
    assert performance.poses[1].any()
    assert performance.moved
    with pytest.raises(ValueError, match="read-only"):
        performance.poses[0, 0] = 1


BAD = [
    ({"times_s": []}, "times_s: expected one time or more"),
    ({"times_s": [[0, 1]]}, "times_s: expected one time or more"),
    ({"times_s": [0, 1, 2]}, "poses: expected the shape"),
    ({"times_s": [0, 0]}, "times_s: expected more than 0 at frame 1, got 0.0"),
    ({"times_s": [1, 0.5]}, "times_s: expected more than 1 at frame 1, got 0.5"),
    ({"times_s": [-1, 0]}, "times_s: expected seconds in 0"),
    ({"times_s": [0, np.nan]}, "times_s: expected seconds in 0"),
    ({"times_s": [0, LONGEST_S + 1]}, "times_s: expected seconds in 0"),
    ({"poses": poses_of([0, np.nan])}, "pose 1: "),
    ({"poses": poses_of([0, 1]) + 1}, "pose 0: "),
    ({"weights": 2 * ALL}, "weights: expected numbers in 0..1, got 2.0"),
    ({"weights": np.nan * ALL}, "weights: expected numbers in 0..1"),
    ({"weights": ALL[:, :-1]}, "weights: expected the shape"),
    ({"rate_hz": 0}, "rate_hz: expected"),
]


@pytest.mark.parametrize(("wrong", "message"), BAD)
def test_what_is_no_performance_is_refused(wrong, message):
    good = {"times_s": [0, 1], "poses": poses_of([0, 1]), "weights": ALL}
    Performance(**good)
    with pytest.raises(InvalidValueError, match=message):
        Performance(**(good | wrong))


@pytest.mark.parametrize("rate", [24.0, 25.0, 30.0, 60.0, 30000 / 1001, 48.0, 240.0])
def test_regular_times_rounded_to_milliseconds_have_a_rate(rate):
    times = np.round(np.arange(400) / rate, 3)
    assert rate_of(times) == pytest.approx(rate, rel=1e-3 / times[-1])


@pytest.mark.parametrize("times", [[0.0], [1.0], [0.0, 0.1, 0.3], [0.0, 1e-5]])
def test_others_have_none(times):
    assert rate_of(np.array(times)) is None
