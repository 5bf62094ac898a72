from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from agentface.emotion.ramps import (
    KNOTS,
    ROUNDED,
    cubic,
    exponential_offset,
    exponential_onset,
    through,
)

EVEN = np.linspace(0.0, 1.0, KNOTS)
FINE = np.linspace(0.0, 1.0, 2001)


@st.composite
def tables(draw):
    times = draw(st.lists(st.integers(1, 99), max_size=6, unique=True))
    levels = draw(st.lists(st.integers(0, 100), min_size=len(times), max_size=len(times)))
    inner = ((time / 100.0, level / 100.0) for time, level in zip(sorted(times), sorted(levels), strict=True))
    return [(0.0, 0.0), *inner, (1.0, 1.0)]


def curve(ramp):
    return CubicHermiteSpline(EVEN, ramp[:, 0], ramp[:, 1])


@pytest.mark.parametrize("ramp", [exponential_onset(), exponential_offset(), through([(0, 0), (0.3, 0.8), (1, 1)])])
def test_a_ramp_goes_from_rest_to_rest_and_never_back(ramp):
    assert ramp[0].tolist() == [0.0, 0.0]
    assert ramp[-1].tolist() == [1.0, 0.0]
    assert np.diff(curve(ramp)(FINE)).min() >= -1e-12
    # no corner: its speed changes by little from one of 2000 moments to the next
    speed = curve(ramp).derivative()(FINE)
    assert np.abs(np.diff(speed)).max() < 0.015 * speed.max()


def test_the_exponential_ramps_are_pure_between_their_rounded_ends():
    middle = FINE[(FINE >= ROUNDED + 1 / 64) & (FINE <= 1.0 - ROUNDED - 1 / 64)]
    onset, offset = curve(exponential_onset()), curve(exponential_offset())
    np.testing.assert_allclose(onset(middle), np.exp(np.log(2.0) * middle) - 1.0, atol=1e-6)
    np.testing.assert_allclose(1.0 - offset(middle), np.exp(np.log(2.0) - np.log(2.0) * middle) - 1.0, atol=1e-6)


def test_rounding_takes_no_more_than_the_documents_say():
    apart = curve(exponential_onset())(FINE) - (np.exp2(FINE) - 1.0)
    assert np.abs(apart[FINE < 0.5]).max() < 0.03
    assert np.abs(apart).max() < 0.055


@given(tables())
def test_a_table_is_met_by_the_monotone_cubic_through_it(points):
    times, levels = np.array(points).T
    ramp = through(points)
    expected = PchipInterpolator(times, levels)
    inner = EVEN[(times[1] <= EVEN) & (times[-2] >= EVEN)] if len(points) > 3 else []
    np.testing.assert_allclose(ramp[np.isin(EVEN, inner), 0], expected(inner), atol=1e-9)
    assert np.diff(ramp[:, 0]).min() >= -1e-12
    assert ramp[:, 1].min() >= -1e-9
    for (time, level), (later, next_level) in pairwise(points):
        between = ramp[(time <= EVEN) & (later >= EVEN), 0]
        assert between.size == 0 or (between.min() >= level - 1e-9 and between.max() <= next_level + 1e-9)


@given(st.floats(0, 1), st.floats(0.01, 2), *[st.floats(-3, 3)] * 4)
def test_the_cubic_is_hermites(u, length, value, slope, next_value, next_slope):
    expected = CubicHermiteSpline([0.0, length], [value, next_value], [slope, next_slope])
    got = cubic(np.float64(u), length, *map(np.float64, (value, slope, next_value, next_slope)))
    np.testing.assert_allclose(got, [expected(u * length), expected.derivative()(u * length)], rtol=1e-8, atol=1e-8)
