from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.motion.modes import LONGEST_S, ModeMean, mean_in_numpy
from agentface.motion.modes_compiled import mean

TICK_S = 0.01
STATES = st.dictionaries(st.sampled_from(EMOTIONS), st.floats(0, 1), max_size=3).map(EmotionState.of)


def weights(states):
    return default_inference().weights(np.array([state.array for state in states]))


def trace(waits, states, most=1):
    """The means of modes that turn to the next of ``states`` after so many ticks each, told ``most`` at once."""
    mode_mean, shown, tick = ModeMean(TICK_S, mean), [], 0
    for ticks, state in zip(waits, states, strict=True):
        mode_mean.turn(tick * TICK_S, (tick + ticks) * TICK_S, at_once=False)
        left = ticks
        while left:
            new = min(left, most)
            times = TICK_S * np.arange(tick + 1.0, tick + new + 1.0)
            shown += list(mode_mean.means(times, np.repeat(weights([state]), new, axis=0)))
            tick, left = tick + new, left - new
    return np.array(shown).reshape(-1, 6, 6)


@given(st.lists(STATES, min_size=1, max_size=9), st.integers(0, 8), st.floats(0, 9))
def test_the_kernel_equals_its_numpy_twin(states, more, ticks):
    told = np.concatenate([np.zeros((10, 6, 6)), weights(states)])
    first, second = np.full((2, 6, 6), np.nan)
    end = max(len(told) - more, 10)
    mean(told, end, ticks, first)
    mean_in_numpy(told, end, ticks, second)
    np.testing.assert_allclose(first, second, atol=1e-12)


@given(st.lists(st.tuples(st.integers(1, 80), STATES), min_size=1, max_size=5))
def test_means_are_shares_and_end_with_what_is_shown(plan):
    shown = trace(*zip(*plan, strict=True))
    assert shown.min() >= 0.0
    sums = shown.sum(axis=(1, 2))
    assert ((np.abs(sums - 1.0) < 1e-9) | (sums == 0.0)).all()
    np.testing.assert_allclose(shown[-1], weights([plan[-1][1]])[0], atol=1e-12)


@given(st.lists(st.tuples(st.integers(1, 60), STATES), min_size=1, max_size=5), st.integers(1, 30))
def test_it_does_not_matter_how_many_ticks_come_at_once(plan, most):
    plan = list(zip(*plan, strict=True))
    np.testing.assert_array_equal(trace(*plan), trace(*plan, most=most))


def test_while_one_mode_is_shown_it_stays_as_it_is():
    shown = trace([50, 50], [EmotionState.of(fear=0.3), EmotionState.of(fear=0.9)])
    np.testing.assert_allclose(shown, np.repeat(weights([EmotionState.of(fear=1.0)]), 100, axis=0), atol=1e-12)


def test_one_goes_over_into_another_over_the_longest_window():
    mode_mean = ModeMean(TICK_S, mean)
    mode_mean.turn(0.0, 10.0, at_once=False)
    anger = np.zeros(300)
    for tick in range(300):
        state = EmotionState.of(anger=1.0) if tick >= 100 else EmotionState.of(fear=1.0)
        (shown,) = mode_mean.means(np.array([TICK_S * (tick + 1.0)]), weights([state]))
        anger[tick] = shown[EMOTIONS.index("anger"), EMOTIONS.index("anger")]
    assert (anger[:100] == 0.0).all()
    assert np.count_nonzero((anger > 0.0) & (anger < 1.0)) == pytest.approx(LONGEST_S / TICK_S, abs=2)
    assert np.diff(anger).max() <= TICK_S / LONGEST_S + 1e-9
