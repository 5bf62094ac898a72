"""No contraction changes by more than 0.05 for a step of 0.01 in one intensity, whatever else the face feels."""

from __future__ import annotations

from itertools import permutations, product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.emotion.inference import Inference, default_inference
from agentface.emotion.rules import Mode, RuleBase
from agentface.emotion.selector import MODES
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.parameters import MUSCLES

pytestmark = pytest.mark.untraced

STEP, LIMIT = 0.01, 0.05
FINE = 4  # positions tried within a step
LEVELS = np.linspace(0.0, 1.0, 21)


def largest_step(inference: Inference, ramped: str, others: dict[str, float]) -> float:
    states = np.tile(EmotionState.of(others).array, (100 * FINE + 1, 1))
    states[:, EMOTIONS.index(ramped)] = np.linspace(0.0, 1.0, len(states))
    ramp = np.array([inference.contractions(EmotionState(state)) for state in states])
    return float(np.abs(ramp[FINE:] - ramp[:-FINE]).max())


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_a_ramp_alone_is_smooth(inference: Inference, emotion: str):
    assert largest_step(inference, emotion, {}) <= 0.03


@pytest.mark.slow
@pytest.mark.parametrize(("emotion", "other"), list(permutations(EMOTIONS, 2)))
def test_a_ramp_against_another_emotion_is_smooth(inference: Inference, emotion: str, other: str):
    assert max(largest_step(inference, emotion, {other: level}) for level in LEVELS.tolist()) <= LIMIT


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(st.lists(st.floats(0.0, 1.0), min_size=6, max_size=6), st.sampled_from(EMOTIONS))
def test_a_ramp_through_a_mix_of_all_six_is_smooth(intensities: list[float], emotion: str):
    others = {name: value for name, value in zip(EMOTIONS, intensities, strict=True) if name != emotion}
    assert largest_step(default_inference(), emotion, others) <= LIMIT


@settings(max_examples=300, deadline=None)
@given(st.lists(st.floats(0.0, 1.0), min_size=6, max_size=6), st.lists(st.floats(-STEP, STEP), min_size=6, max_size=6))
def test_a_step_of_all_six_is_no_more_than_the_sum_of_theirs(intensities: list[float], steps: list[float]):
    inference = default_inference()
    moved = np.clip(np.array(intensities) + steps, 0.0, 1.0)
    change = np.abs(
        inference.contractions(EmotionState(moved)) - inference.contractions(EmotionState(intensities))
    ).max()
    assert change <= LIMIT / STEP * np.abs(moved - intensities).sum() + 1e-9


def allowed_rows() -> list[list[int]]:
    """Every row that the rule files may hold."""
    steps = product((0, 1, 2), (-1, 0, 1), (-1, 0, 1), (-1, 0, 1))
    rows = [np.cumsum([0, *step]) for step in steps]
    return [row.tolist() for row in rows if row.min() >= 0 and row.max() <= 4]


@pytest.mark.slow
@settings(max_examples=25, deadline=None)
@given(st.data())
def test_any_rules_that_the_files_may_hold_are_smooth(data: st.DataObject):
    rows = st.sampled_from(allowed_rows())
    first = {muscle: np.array(data.draw(rows), np.int8) for muscle in MUSCLES}
    second = {muscle: np.array(data.draw(st.just([0] * 5) | rows), np.int8) for muscle in MUSCLES}
    blend = {}
    for number, muscle in enumerate(MUSCLES):
        one, two = np.broadcast_arrays(first[muscle][:, None], second[muscle][None, :])
        blend[muscle] = (one, two, np.maximum(one, two), np.minimum(one, 2), np.zeros_like(one))[number % 5]
    rules = {MODES[0]: first, MODES[1]: second, MODES[6]: blend}
    inference = Inference(RuleBase(tuple(Mode(mode, "", "", rules.get(mode, {})) for mode in MODES), 0.2))
    level = data.draw(st.sampled_from((0.1, 0.24, 0.25, 0.26, 0.375, 0.6, 0.75)) | st.floats(0.0, 1.0))
    for ramped, other in permutations(EMOTIONS[:2]):
        assert largest_step(inference, ramped, {other: level}) <= LIMIT
