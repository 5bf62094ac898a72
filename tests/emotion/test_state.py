from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.state import ALIASES, EMOTIONS, EmotionState, canonical
from agentface.errors import InvalidValueError, UnknownNameError


def test_names_and_aliases_mean_one_of_the_six():
    assert EMOTIONS == ("happiness", "sadness", "anger", "fear", "disgust", "surprise")
    assert {canonical(name) for name in (*EMOTIONS, *ALIASES)} == set(EMOTIONS)
    assert not set(ALIASES) & set(EMOTIONS)
    assert canonical(" Joy ") == "happiness"


@pytest.mark.parametrize("name", ["hapiness", "", "neutral", None, 3, b"fear", ["fear"]])
def test_an_unknown_emotion_is_refused_by_name(name: Any):
    with pytest.raises(UnknownNameError, match="emotion"):
        canonical(name)


def test_a_misspelt_emotion_gets_a_hint():
    with pytest.raises(UnknownNameError, match="did you mean happiness"):
        EmotionState.of(hapiness=0.5)


@pytest.mark.parametrize("value", [-0.01, 1.01, float("nan"), float("inf"), "0.5", True, None, [0.5]])
def test_an_intensity_that_is_no_fraction_is_refused(value: Any):
    with pytest.raises(InvalidValueError, match="fear"):
        EmotionState.of({"fear": value})


@pytest.mark.parametrize("given", [[0.0] * 5, [0.0] * 7, 0.3, [[0.0] * 6]])
def test_six_intensities_make_a_state(given: Any):
    with pytest.raises(InvalidValueError, match="6 intensities"):
        EmotionState(given)


def test_two_names_of_one_emotion_are_refused():
    with pytest.raises(InvalidValueError, match="happiness"):
        EmotionState.of({"joy": 0.2, "happy": 0.4})


def test_only_a_mapping_makes_a_state_by_name():
    with pytest.raises(InvalidValueError, match="mapping"):
        EmotionState.of([("fear", 0.5)])  # type: ignore[arg-type]


@given(st.lists(st.floats(0.0, 1.0), min_size=6, max_size=6))
def test_a_state_is_a_mapping_that_keeps_its_numbers(values: list[float]):
    state = EmotionState(values)
    assert [state[name] for name in state] == values
    assert dict(state.items()) == state.as_dict() == dict(zip(EMOTIONS, values, strict=True))
    assert list(state.values()) == values
    assert EmotionState.of(state.as_dict()) == state == state.as_dict()
    assert hash(EmotionState.of(state.as_dict())) == hash(EmotionState(np.array(values)))


def test_a_state_cannot_be_changed():
    given = np.zeros(6)
    state = EmotionState(given)
    given[0] = 1.0
    assert state["happiness"] == 0.0
    with pytest.raises(ValueError, match="read-only"):
        state.array[0] = 1.0
    with pytest.raises(TypeError):
        state["fear"] = 1.0  # type: ignore[index]


def test_an_alias_reads_a_state():
    state = EmotionState.of(angry=0.5)
    assert state["anger"] == 0.5
    assert "angry" in state
    assert "hungry" not in state
    assert repr(state) == "EmotionState.of(anger=0.5)"


@given(st.lists(st.floats(0.0, 1.0), min_size=6, max_size=6))
def test_a_state_pickles_and_copies(values: list[float]):
    state = EmotionState(values)
    for twin in (pickle.loads(pickle.dumps(state)), copy.copy(state), copy.deepcopy(state)):  # noqa: S301 - our own
        assert type(twin) is EmotionState
        assert twin == state
        assert hash(twin) == hash(state)
        assert not twin.array.flags.writeable
