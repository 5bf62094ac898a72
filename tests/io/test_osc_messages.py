"""What each message does to the face."""

from __future__ import annotations

import math

import pytest
from osc_bytes import message

from agentface import EmotionState


def test_emotion_with_fade_and_hold(desk):
    desk.take(message("/agentface/emotion", "sfff", "joy", 0.5, 0.1, 0.2))
    assert desk.state == EmotionState.of(happiness=0.5)
    desk.face.step(0.29)
    assert desk.face.status()["shown"]["emotion"]["happiness"] == 0.5
    desk.face.step(0.2)
    assert desk.state == EmotionState()
    assert not desk.answers


def test_emotion_keeps_the_others_and_emotions_does_not(desk):
    desk.take(message("/agentface/emotion", "sf", "anger", 0.25))
    desk.take(message("/agentface/emotion", "sf", "fear", 0.5))
    assert desk.state == EmotionState.of(anger=0.25, fear=0.5)
    desk.take(message("/agentface/emotions", "sfsf", "disgust", 0.75, "sad", 0.5))
    assert desk.state == EmotionState.of(disgust=0.75, sadness=0.5)
    desk.take(message("/agentface/neutral"))
    assert desk.state == EmotionState()


def test_muscle_gaze_head_blink_and_whole_numbers(desk):
    desk.take(
        message("/agentface/muscle", "sf", "zygomaticus_major_l", 0.5),
        message("/agentface/muscle", "si", "jaw_open", 1),
        message("/agentface/gaze", "fff", 10, -5, 0),
        message("/agentface/head", "ffd", 20, 5, 3),
        message("/agentface/blink"),
    )
    desk.face.step(0.09)
    assert desk.face.pose["orbicularis_oculi_palpebralis_l"] == 1.0
    desk.face.step(1.0)
    pose = desk.face.pose
    assert pose["zygomaticus_major_l"] == 0.5
    assert pose["zygomaticus_major_r"] == 0.0
    assert pose["jaw_open"] == 1.0
    assert desk.face.status()["gaze_deg"] == [10, -5]
    assert math.degrees(pose["head_yaw"]) == pytest.approx(20)
    assert desk.face.message_counts.messages == 5


def test_the_mouth_is_driven_by_visemes(desk):
    desk.take(message("/agentface/viseme", "sf", "aa", 1.0), message("/agentface/viseme", "sff", "PP", 1.0, 0.5))
    desk.face.step(1.0)
    opened = desk.face.pose["jaw_open"]
    assert opened > 0.1
    desk.take(message("/agentface/hush"))
    desk.face.step(0.2)
    assert desk.face.pose["jaw_open"] == 0.0
    desk.take(message("/agentface/visemes", "sffsff", "p", 0.0, 0.1, "AA1", 0.1, 0.4))
    desk.face.step(0.2)
    assert desk.face.status()["speech"] == {"phone": "AA1", "ends_in_s": 0.2, "waiting": 0}
    desk.take(message("/agentface/visemes", "sff", "iy", 0.1, 0.6))
    assert desk.face.status()["speech"]["ends_in_s"] == pytest.approx(0.6, abs=1e-3)
    desk.take(message("/agentface/hush"))
    assert desk.face.status()["speech"] is None
    assert not desk.answers


def test_parameters_and_points_reach_what_is_no_muscle(desk):
    desk.take(
        message("/agentface/parameter", "sf", "head_roll", 0.25),
        message("/agentface/parameter", "sf", "head_pitch_deg", -10.0),
        message("/agentface/parameter", "sf", "mentalis", 0.5),
        message("/agentface/look_at", "ffff", 0.0, 0.0, 1.0, 0.0),
    )
    desk.face.step(1.0)
    pose = desk.face.pose
    assert (pose["head_roll"], pose["mentalis_l"], pose["mentalis_r"]) == (0.25, 0.5, 0.5)
    assert math.degrees(pose["head_pitch"]) == pytest.approx(-10, abs=1e-4)
    assert math.degrees(pose["gaze_pitch"]) > 8
    assert pose["gaze_vergence"] > 0.01
    assert not desk.answers


def test_neutral_as_an_emotion_keeps_the_muscles(desk):
    desk.take(message("/agentface/emotion", "sf", "joy", 0.5), message("/agentface/muscle", "sf", "risorius", 0.5))
    desk.take(message("/agentface/emotion", "sf", "neutral", 1.0))
    assert desk.state == EmotionState()
    assert desk.face.held
    desk.take(message("/agentface/emotions", "sfsf", "happy", 0.75, "neutral", 0.25))
    assert desk.state == EmotionState.of(happiness=0.75)


def test_neutral_takes_its_fade(desk):
    desk.take(message("/agentface/emotion", "sff", "joy", 1.0, 0.0), message("/agentface/neutral", "f", 2.0))
    desk.face.step(1.0)
    assert 0.3 < desk.face.status()["shown"]["emotion"]["happiness"] < 0.7
    desk.face.step(1.0)
    assert desk.face.status()["shown"]["emotion"]["happiness"] == 0.0


def test_a_mood_is_what_brief_expressions_return_to_until_it_is_cleared(desk):
    desk.take(message("/agentface/mood", "sfsf", "joy", 0.5, "surprise", 0.25))
    assert desk.state == desk.face.mood == EmotionState.of(happiness=0.5, surprise=0.25)
    desk.take(message("/agentface/emotion", "sfff", "anger", 0.9, 0.1, 0.5))
    assert desk.state["anger"] > 0.5
    desk.face.step(0.7)
    for _ in range(3):
        assert desk.state == desk.face.mood
        desk.take(message("/agentface/neutral"))
    assert desk.face.status()["mood"]["happiness"] == 0.5
    desk.take(message("/agentface/mood"))
    assert desk.state == desk.face.mood == EmotionState()
    assert not desk.answers


def test_an_emotion_may_take_its_own_time(desk):
    desk.take(message("/agentface/emotion", "sfNs", "surprise", 0.9, "own"))
    desk.face.step(0.9)
    assert desk.face.status()["shown"]["emotion"]["surprise"] == 0.9
    desk.face.step(1.0)
    assert desk.state == EmotionState()


def test_symbols_arrays_and_rounded_peaks_are_taken(desk):
    desk.take(message("/agentface/emotion", "Sf", "happiness", 0.75))
    assert desk.state == EmotionState.of(happiness=0.75)
    desk.take(message("/agentface/emotions", "[sf][sf]", "joy", 0.5, "fear", 0.25))
    assert desk.state == EmotionState.of(happiness=0.5, fear=0.25)
    desk.take(message("/agentface/emotion", "sf", "happiness", 1.0000001))
    assert desk.state["happiness"] == 1.0
    desk.take(message("/agentface/emotion", "sf", "happiness", -1e-7))
    assert desk.state["happiness"] == 0.0
    desk.take(
        message("/agentface/gaze", "ff", 50.00001, -40.00001), message("/agentface/muscle", "sf", "nasalis", 1.0000001)
    )
    desk.face.step(1.0)
    assert desk.face.status()["gaze_deg"] == [50, -40]
    assert not desk.answers
