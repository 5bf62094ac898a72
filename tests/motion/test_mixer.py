from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.inference import default_inference
from agentface.emotion.state import EmotionState
from agentface.motion.blink import CLOSE_S, HOLD_S, OPEN_S
from agentface.motion.mixer import Mixer


@pytest.fixture
def mixer():
    return Mixer(default_inference())


def test_the_emotion_ends_where_the_rules_say(mixer):
    mixer.emotion.change({"fear": 0.6, "surprise": 0.3}, 0.2, None)
    mixer.advance(0.2)
    np.testing.assert_array_equal(mixer.pose().array, default_inference().pose({"fear": 0.6, "surprise": 0.3}).array)
    assert mixer.emotion.target == EmotionState.of(fear=0.6, surprise=0.3)


def test_hold_returns_one_emotion_and_leaves_the_others(mixer):
    mixer.emotion.change({"anger": 0.4}, 0.1, None)
    mixer.emotion.change({"surprise": 1.0}, 0.2, 0.5)
    mixer.advance(0.69)
    assert mixer.emotion.target == EmotionState.of(anger=0.4, surprise=1.0)
    mixer.advance(0.02)
    assert mixer.emotion.target == EmotionState.of(anger=0.4)
    mixer.advance(0.2)
    np.testing.assert_array_equal(mixer.pose().array, default_inference().pose({"anger": 0.4}).array)


def test_a_newer_message_cancels_the_hold(mixer):
    mixer.emotion.change({"fear": 1.0}, 0.1, 0.2)
    mixer.emotion.change({"fear": 0.5}, 0.1, None)
    mixer.advance(5.0)
    assert mixer.emotion.target == EmotionState.of(fear=0.5)


@pytest.mark.untraced
@given(st.integers(1, 60))
def test_frame_rate_does_not_change_the_motion(frames):
    fine, coarse = Mixer(default_inference()), Mixer(default_inference())
    for mixer in (fine, coarse):
        mixer.emotion.change({"disgust": 0.9}, 0.13, 0.21)
        mixer.blink.blink()
        mixer.muscles.set("jaw_open", 0.4, 0.3)
    for _ in range(frames):
        fine.advance(0.5 / frames)
    coarse.advance(0.5)
    np.testing.assert_allclose(fine.pose().array, coarse.pose().array, atol=1e-6)


def test_a_muscle_set_by_name_wins_and_can_be_given_back(mixer):
    mixer.emotion.change({"happiness": 1.0}, 0.0, None)
    smile = mixer.pose()["zygomaticus_major_l"]
    assert smile > 0.5
    mixer.muscles.set("zygomaticus_major_l", 0.1, 0.2)
    assert mixer.pose()["zygomaticus_major_l"] == pytest.approx(smile)
    mixer.advance(0.1)
    assert 0.1 < mixer.pose()["zygomaticus_major_l"] < smile
    mixer.advance(0.1)
    assert mixer.pose()["zygomaticus_major_l"] == pytest.approx(0.1)
    assert mixer.pose()["zygomaticus_major_r"] == pytest.approx(smile)
    mixer.muscles.release(0.2)
    mixer.advance(0.2)
    assert mixer.pose()["zygomaticus_major_l"] == pytest.approx(smile)


def test_a_muscle_held_at_zero_stays_there(mixer):
    mixer.muscles.set("zygomaticus_major", 0.0, 0.0)
    mixer.emotion.change({"happiness": 1.0}, 0.0, None)
    assert mixer.pose()["zygomaticus_major_l"] == 0.0


def test_a_blink_closes_and_opens_whatever_the_lids_do(mixer):
    mixer.emotion.change({"surprise": 1.0}, 0.0, None)
    before = mixer.pose()
    assert before["levator_palpebrae_l"] > 0.0
    mixer.blink.blink()
    mixer.advance(CLOSE_S + HOLD_S / 2)
    assert mixer.pose()["orbicularis_oculi_palpebralis_l"] == 1.0
    assert mixer.pose()["levator_palpebrae_r"] == 0.0
    mixer.advance(HOLD_S / 2 + OPEN_S)
    assert mixer.pose() == before


def test_gaze_and_head_are_independent_of_the_muscles(mixer):
    mixer.gaze.turn((0.2, -0.1, 0.05), 0.0)
    mixer.head.turn((0.3, 0.1, -0.2), 0.0)
    pose = mixer.pose()
    turned = {name: value for name, value in pose.items() if value}
    assert turned == pytest.approx(
        {
            "gaze_yaw": 0.2,
            "gaze_pitch": -0.1,
            "gaze_vergence": 0.05,
            "head_yaw": 0.3,
            "head_pitch": 0.1,
            "head_roll": -0.2,
        }
    )
