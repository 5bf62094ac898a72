"""How much of each expression a face shows: what it was told, and what only its pose tells."""

from __future__ import annotations

import numpy as np
import pytest

from agentface import Face
from agentface.emotion.inference import default_inference
from agentface.emotion.state import EMOTIONS
from agentface.parameters import FacePose
from agentface.requests import SetTracked
from agentface.vrm.expressions import PRESETS, expression_table
from agentface.vrm.shown_expressions import ShownExpressions
from agentface.vrm.tracked import Tracked
from tests.heads import head_model

EMOTIONAL = ("happy", "angry", "sad", "surprised")
SAID = ("aa", "ih", "ou", "ee", "oh")


@pytest.fixture(scope="module")
def shown():
    return ShownExpressions(head_model(), default_inference())


@pytest.fixture
def face():
    return Face(head_model())


def seen(shown, face):
    weights = dict(zip(PRESETS, shown.weights(face.pose.array, face.channels).tolist(), strict=True))
    assert all(0.0 <= weight <= 1.0 for weight in weights.values())
    return weights


def near(**weights):
    return pytest.approx(dict.fromkeys(PRESETS, 0.0) | weights, abs=0.03)


def test_a_face_at_rest_shows_none(shown, face):
    assert seen(shown, face) == dict.fromkeys(PRESETS, 0.0)


@pytest.mark.parametrize("level", [0.25, 0.7, 1.0])
@pytest.mark.parametrize("emotion", EMOTIONS)
def test_an_emotion_is_told_as_the_table_says(shown, face, emotion, level):
    face.set_emotion(emotion, level, fade=0.0)
    face.step(0.1)
    assert seen(shown, face) == near(**{name: part * level for name, part in expression_table().felt[emotion].items()})


@pytest.mark.parametrize("name", SAID)
def test_a_viseme_is_its_own(shown, face, name):
    face.show_viseme(expression_table()[name].viseme, 0.7)
    face.step(0.5)
    assert seen(shown, face) == near(**{name: 0.7})


def test_what_is_said_is_no_emotion_and_smiles_are_no_vowel(shown, face):
    sounds = zip(
        ("hh", "eh", "l", "oh", "p", "aa"), (0.0, 0.1, 0.2, 0.3, 0.5, 0.6), (0.1, 0.2, 0.3, 0.5, 0.6, 0.9), strict=True
    )
    face.speak(list(sounds))
    most = dict.fromkeys(PRESETS, 0.0)
    for _ in range(60):
        face.step(1 / 60)
        most = {name: max(weight, most[name]) for name, weight in seen(shown, face).items()}
    assert max(most[name] for name in EMOTIONAL) < 0.05
    assert most["oh"] > 0.5
    assert most["aa"] > 0.5
    face.step(5.0)
    face.set_emotion("happiness", 1.0, fade=0.0)
    face.show_viseme("aa", 0.6)
    face.step(0.5)
    assert seen(shown, face) == near(happy=1.0, aa=0.6)


def test_sealed_lips_say_no_vowel(shown, face):
    face.show_viseme("PP", 1.0)
    face.set_muscle("jaw_open", 0.5, fade=0.0)
    face.step(0.5)
    assert seen(shown, face) == near()


def test_what_both_lids_have_in_common_is_a_blink(shown, face):
    face.set_muscle("orbicularis_oculi_palpebralis_l", 0.9, fade=0.0)
    face.set_muscle("orbicularis_oculi_palpebralis_r", 0.4, fade=0.0)
    face.step(0.1)
    assert seen(shown, face) == near(blink=0.4, blinkLeft=0.5)


@pytest.mark.parametrize(
    ("yaw", "pitch", "name"), [(10, 0, "lookLeft"), (-10, 0, "lookRight"), (0, 8, "lookUp"), (0, -8, "lookDown")]
)
def test_gaze_is_to_the_person_s_sides(shown, face, yaw, pitch, name):
    face.set_gaze(yaw, pitch, fade=0.0)
    face.step(0.1)
    limit = head_model().eyes.yaw_limit_deg if yaw else head_model().eyes.pitch_limit_deg
    assert seen(shown, face) == near(**{name: abs(yaw or pitch) / limit})


@pytest.mark.parametrize(
    "asked",
    [{"happy": 0.7}, {"happy": 0.5, "aa": 0.5}, {"surprised": 0.8}, {"sad": 0.4, "ou": 0.3}, {"angry": 1.0},
     {"ou": 0.6, "ih": 0.3}, {"blinkRight": 1.0}, {"lookLeft": 0.5, "lookUp": 0.3}],
)  # fmt: skip
def test_what_only_the_pose_tells_is_found_again(shown, face, asked):
    whole = dict.fromkeys(PRESETS, 0.0) | asked
    face.apply(SetTracked(Tracked(expressions=tuple(whole.items())), 0.0))
    face.step(0.05)
    assert seen(shown, face) == near(**asked)


def test_a_stream_hides_what_was_told_as_far_as_it_moves_it(shown, face):
    face.set_emotion("happiness", 1.0, fade=0.0)
    face.apply(SetTracked(Tracked(expressions=tuple(dict.fromkeys(PRESETS, 0.0).items())), 0.0))
    face.step(0.05)
    assert seen(shown, face) == near()
    face.step(0.5)
    part = seen(shown, face)["happy"]
    assert 0.0 <= part < 1.0
    face.step(2.0)
    assert seen(shown, face) == near(happy=1.0)


def test_no_pose_is_too_strange(shown, face):
    draw = np.random.default_rng(0)
    for _ in range(200):
        values = draw.uniform(FacePose().array - 1.0, FacePose().array + 1.0).astype(np.float32)
        weights = shown.weights(values, face.channels)
        assert ((weights >= 0.0) & (weights <= 1.0)).all()
