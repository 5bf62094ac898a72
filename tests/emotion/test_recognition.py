"""Emotions read off contractions."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.emotion.inference import default_inference
from agentface.emotion.recognition import states_shown
from agentface.emotion.state import EMOTIONS
from agentface.parameters import MUSCLES


def drawn(seed, count=120):
    """States of one emotion or two, those of which are strong enough to be told apart."""
    draw, states = np.random.default_rng(seed), np.zeros((count, len(EMOTIONS)))
    for state in states:
        two = draw.choice(len(EMOTIONS), 2, replace=False)
        state[two] = draw.uniform(0.2, 1.0, 2) * [1.0, draw.random() < 0.5]
    return states


def test_the_face_that_is_read_is_the_face_that_was_shown():
    inference = default_inference()
    states = drawn(0)
    asked = inference.course(states)
    found = inference.course(states_shown(inference, asked))
    assert np.abs(found - asked).mean() < 0.01
    assert np.sqrt(((found - asked) ** 2).mean(axis=1)).max() < 0.08


@pytest.mark.parametrize("emotion", EMOTIONS)
@pytest.mark.parametrize("level", [0.3, 0.55, 0.8, 1.0])
def test_an_emotion_alone_is_read_alone_and_as_strong(emotion, level):
    inference, state = default_inference(), np.zeros((1, len(EMOTIONS)))
    state[0, EMOTIONS.index(emotion)] = level
    found = states_shown(inference, inference.course(state))
    assert np.flatnonzero(found[0]).tolist() == [EMOTIONS.index(emotion)]
    assert inference.course(found) == pytest.approx(inference.course(state), abs=0.06), "some are whole before 1"
    if level < 0.75:
        assert found == pytest.approx(state, abs=0.06)


def test_muscles_that_do_not_move_are_not_compared():
    inference = default_inference()
    moved = np.array([name not in ("jaw_open", "orbicularis_oris_press") for name in MUSCLES])
    contractions = inference.contractions({"happiness": 0.7})
    contractions[~moved] = 0.9
    found = states_shown(inference, contractions[None], moved)[0]
    assert found == pytest.approx(np.where(np.array(EMOTIONS) == "happiness", 0.7, 0.0), abs=0.06)


def test_a_face_at_rest_feels_nothing_and_no_faces_give_no_states():
    inference = default_inference()
    assert not states_shown(inference, np.zeros((3, len(MUSCLES)))).any()
    assert states_shown(inference, np.zeros((0, len(MUSCLES)))).shape == (0, len(EMOTIONS))
