from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.inference import Inference, default_inference
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.parameters import MUSCLES, indices_of

INTENSITIES = st.lists(st.floats(0.0, 1.0), min_size=6, max_size=6)


def test_neutral_is_exactly_at_rest(inference: Inference):
    assert not inference.contractions(EmotionState()).any()
    assert not inference.pose({}).array.any()


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_full_intensity_is_full_strength(inference: Inference, emotion: str):
    rules = inference.rulebase.mode((emotion,)).consequents
    contractions = inference.contractions({emotion: 1.0})
    for muscle, contraction in zip(MUSCLES, contractions, strict=True):
        assert contraction == (rules[muscle][-1] / 4 if muscle in rules else 0.0)
    assert contractions.max() == 1.0


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_at_the_centre_of_a_set_its_column_is_shown(inference: Inference, emotion: str):
    for column in range(5):
        contractions = inference.contractions({emotion: column / 4})
        for muscle, rules in inference.rulebase.mode((emotion,)).consequents.items():
            assert contractions[MUSCLES.index(muscle)] == rules[column] / 4


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_a_ramp_grows_and_never_falls(inference: Inference, emotion: str, gives_way: set[tuple[str, str]]):
    ramp = np.array([inference.contractions({emotion: level}) for level in np.linspace(0.0, 1.0, 1001)])
    falling = {muscle for of, muscle in gives_way if of == emotion}
    kept = [index for index, muscle in enumerate(MUSCLES) if muscle not in falling]
    assert np.diff(ramp[:, kept], axis=0).min() >= -1e-12
    assert np.diff(ramp.sum(axis=1)).min() >= -1e-12, "the whole face never relaxes as an emotion grows"


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_the_least_intensity_moves_the_face_least(inference: Inference, emotion: str):
    assert inference.contractions({emotion: math.ulp(0.0)}).max() < 1e-9
    assert inference.contractions({emotion: 1e-6}).max() < 1e-5


@given(INTENSITIES)
def test_the_kernel_equals_its_numpy_twin(intensities: list[float]):
    inference, state = default_inference(), EmotionState(intensities)
    expected = list(inference.explain(state).contractions.values())
    assert inference.contractions(state) == pytest.approx(expected, abs=1e-12)


@given(st.lists(INTENSITIES, min_size=1, max_size=4))
def test_states_at_once_are_each_what_it_is_by_itself(states: list[list[float]]):
    plain, kernel = default_inference(compiled=False), default_inference()
    assert (plain.compiled, kernel.compiled) == (False, True)
    each = [kernel.contractions(EmotionState(state)) for state in states]
    for inference in (plain, kernel):
        np.testing.assert_allclose(inference.course(np.array(states)), each, atol=1e-12)


@given(INTENSITIES)
def test_contractions_are_fractions_and_only_of_muscles_with_rules(intensities: list[float]):
    inference, state = default_inference(), EmotionState(intensities)
    contractions = inference.contractions(state)
    assert contractions.shape == (len(MUSCLES),)
    assert ((contractions >= 0.0) & (contractions <= 1.0)).all()
    felt = [emotion for emotion, intensity in state.items() if intensity > 0.0]
    used = {muscle for emotion in felt for muscle in inference.rulebase.mode((emotion,)).consequents}
    assert not any(value for muscle, value in zip(MUSCLES, contractions, strict=True) if muscle not in used)


@given(INTENSITIES)
def test_the_same_state_gives_the_same_bits(intensities: list[float]):
    inference = default_inference()
    other = Inference(inference.rulebase)
    assert (
        inference.contractions(EmotionState(intensities)).tobytes()
        == other.contractions(EmotionState(intensities)).tobytes()
    )


def test_a_pose_holds_the_contractions_on_both_sides(inference: Inference):
    state = EmotionState.of(fear=0.7, anger=0.6)
    pose = inference.pose(state)
    moved = set()
    for muscle, contraction in zip(MUSCLES, inference.contractions(state), strict=True):
        for index in indices_of(muscle):
            assert pose.array[index] == np.float32(contraction)
            moved.add(index)
    assert not any(pose.array[index] for index in range(len(pose)) if index not in moved)


def test_a_blend_has_the_brows_of_one_and_the_mouth_of_the_other(inference: Inference):
    pose = inference.pose({"happiness": 0.75, "anger": 0.75})
    assert pose["corrugator_supercilii_l"] == inference.pose({"anger": 0.75})["corrugator_supercilii_l"] > 0.7
    assert pose["zygomaticus_major_l"] == inference.pose({"happiness": 0.75})["zygomaticus_major_l"] > 0.7
    assert pose["orbicularis_oris_press"] == 0.0


def test_three_emotions_show_something_of_each(inference: Inference):
    pose = inference.pose({"happiness": 0.7, "anger": 0.7, "surprise": 0.7})
    assert min(pose[name] for name in ("zygomaticus_major_r", "corrugator_supercilii_r", "frontalis_lateralis_r")) > 0.1


@pytest.mark.parametrize("state", [{"fear": 2.0}, {"fear": math.nan}, {"fear": "1"}, 0.4, "fear"])
def test_a_wrong_state_is_refused(inference: Inference, state: Any):
    with pytest.raises(InvalidValueError):
        inference.contractions(state)


def test_an_unknown_emotion_is_refused(inference: Inference):
    with pytest.raises(UnknownNameError, match="did you mean"):
        inference.pose({"angre": 0.5})
