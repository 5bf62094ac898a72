from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from agentface.emotion.selector import MODES, mode_weights, participation
from agentface.emotion.state import EMOTIONS, EmotionState

GAP = 0.2
INTENSITIES = st.lists(st.floats(0.0, 1.0), min_size=6, max_size=6).map(np.array)


def weights_of(**intensities: float) -> dict[tuple[str, ...], float]:
    return mode_weights(EmotionState.of(**intensities).array, GAP)


def as_array(weights: dict[tuple[str, ...], float]) -> np.ndarray:
    return np.array([weights.get(mode, 0.0) for mode in MODES])


def test_one_emotion_alone_is_single():
    assert weights_of(fear=0.05) == {("fear",): 1.0}
    assert weights_of(fear=1.0) == {("fear",): 1.0}


def test_neutral_calls_for_nothing():
    assert weights_of() == {}


@pytest.mark.parametrize("level", [1e-6, 0.1, 0.5, 1.0])
def test_two_equals_are_a_blend(level: float):
    assert weights_of(fear=level, anger=level) == {("anger", "fear"): 1.0}


def test_single_and_blend_weigh_the_same_at_the_gap():
    assert weights_of(fear=0.8, anger=0.6) == pytest.approx({("fear",): 0.5, ("anger", "fear"): 0.5})
    assert weights_of(fear=0.8, anger=0.39) == {("fear",): 1.0}


def test_a_weak_second_emotion_hardly_blends():
    assert weights_of(fear=0.3, anger=0.05)["fear",] > 0.8


def test_the_rank_of_three_decides():
    weights = weights_of(fear=0.8, anger=0.7, sadness=0.6)
    assert weights["anger", "fear"] == max(weights.values())
    assert weights == pytest.approx(
        {
            ("fear",): 0.25,
            ("anger", "fear"): 0.25 + 0.5 / 3,
            ("sadness", "fear"): 0.5 / 3,
            ("sadness", "anger"): 0.5 / 3,
        }
    )


@given(INTENSITIES)
@example(np.ones(6))
@example(np.array([5e-324, 0, 0, 0, 0, 0]))
def test_the_weights_of_a_state_sum_to_one(intensities: np.ndarray):
    weights = mode_weights(intensities, GAP)
    assert sum(weights.values()) == pytest.approx(1.0 if intensities.any() else 0.0)
    assert min(weights.values(), default=1.0) > 0.0


@given(INTENSITIES)
def test_the_weights_are_the_measure_of_the_alpha_cuts(intensities: np.ndarray):
    degrees = participation(intensities, GAP)
    expected = np.zeros(len(MODES))
    edges = np.unique(np.concatenate([[0.0, 1.0], degrees]))
    for low, high in pairwise(edges):
        cut = [name for name, degree in zip(EMOTIONS, degrees, strict=True) if degree >= (low + high) / 2]
        called = [
            number for number, mode in enumerate(MODES) if set(mode) <= set(cut) and len(mode) == min(2, len(cut))
        ]
        expected[called] += (high - low) / max(1, len(called))
    assert as_array(mode_weights(intensities, GAP)) == pytest.approx(expected, abs=1e-12)


@given(INTENSITIES, st.permutations(range(6)))
def test_the_order_of_the_emotions_does_not_matter(intensities: np.ndarray, order: list[int]):
    moved = mode_weights(intensities[order], GAP)
    for mode, weight in mode_weights(intensities, GAP).items():
        places = sorted(order.index(EMOTIONS.index(name)) for name in mode)
        assert moved[tuple(EMOTIONS[place] for place in places)] == pytest.approx(weight)


@given(INTENSITIES.filter(lambda x: x.max() >= 0.4), st.integers(0, 5), st.floats(-0.01, 0.01))
def test_the_weights_are_lipschitz(intensities: np.ndarray, emotion: int, step: float):
    moved = intensities.copy()
    moved[emotion] = np.clip(moved[emotion] + step, 0.0, 1.0)
    top = min(intensities.max(), moved.max(), 2 * GAP)
    change = np.abs(as_array(mode_weights(moved, GAP)) - as_array(mode_weights(intensities, GAP))).sum()
    assert change <= 2.0 * abs(step) / top + 1e-9
