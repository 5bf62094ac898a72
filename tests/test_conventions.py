from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.conventions import ROUNDING, check_fraction, check_range
from agentface.emotion.state import EmotionState
from agentface.errors import InvalidValueError


@pytest.mark.parametrize("value", [1.0000001, float(np.nextafter(np.float32(1), np.float32(2))), 1.0 + ROUNDING])
def test_what_rounding_puts_over_one_is_one(value):
    assert check_fraction("x", value) == 1.0
    assert EmotionState.of(joy=value)["happiness"] == 1.0


@pytest.mark.parametrize("value", [-1e-7, -ROUNDING, -0.0])
def test_what_rounding_puts_under_zero_is_zero(value):
    assert check_fraction("x", value) == 0.0


@pytest.mark.parametrize("value", [1.0 + 2 * ROUNDING, 1.01, -2 * ROUNDING, math.nan, math.inf, True, "1", None])
def test_what_is_further_outside_is_refused(value):
    with pytest.raises(InvalidValueError):
        check_fraction("x", value)


@given(st.floats(-100, 100), st.floats(0, 100), st.floats(0, 1))
def test_within_the_range_a_number_stays_what_it_is(low, width, part):
    value = min(low + part * width, low + width)
    assert check_range("x", value, low, low + width) == value


@given(st.floats(-100, 100), st.floats(0, 100), st.floats(-300, 300))
def test_what_is_taken_lies_within_and_is_near(low, width, value):
    high = low + width
    try:
        taken = check_range("x", value, low, high)
    except InvalidValueError:
        assert not low <= value <= high
        return
    assert low <= taken <= high
    assert abs(taken - value) <= 1.0001 * ROUNDING * max(abs(low), abs(high))
