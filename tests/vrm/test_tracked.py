"""A tracker's frames on a face: what they move, how they go over into each other, and how they let go."""

from __future__ import annotations

import math
import pickle

import numpy as np
import pytest

from agentface import Face
from agentface.emotion.inference import default_inference
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.parameters import COUNT, indices_of
from agentface.requests import SetArkit, SetTracked
from agentface.requests.tracked import tracker_channel
from agentface.speech.visemes import viseme_table
from agentface.vrm.expression_poses import ExpressionPoses
from agentface.vrm.expressions import PRESETS
from agentface.vrm.tracked import Tracked
from tests.heads import head_model


@pytest.fixture
def face():
    return Face(head_model())


def show(face, frame, dt=0.05):
    face.apply(SetTracked(frame, 0.0))
    face.step(dt)
    return face.pose


def test_emotions_are_the_rules_and_visemes_their_own_shapes(face):
    poses, inference = ExpressionPoses(face.model, default_inference()), default_inference()
    np.testing.assert_allclose(poses.pose({"happy": 0.6})[0], inference.pose({"happiness": 0.6}).array, atol=1e-6)
    np.testing.assert_allclose(poses.pose({"oh": 0.5})[0], 0.5 * viseme_table()["oh"].values, atol=1e-6)
    mixed = poses.pose({"oh": 1.0, "aa": 1.0})[0]
    np.testing.assert_allclose(mixed, 0.5 * (viseme_table()["oh"].values + viseme_table()["aa"].values), atol=1e-6)


def test_names_alone_say_what_is_moved(face):
    poses = ExpressionPoses(face.model, default_inference())
    for name in PRESETS:
        (still, held), (_, moved) = poses.pose({name: 0.0}), poses.pose({name: 1.0})
        np.testing.assert_array_equal(held, moved)
        assert not still.any()
        assert moved.any() == (name != "neutral")


def test_weights_are_solved_as_those_of_arkit(face):
    weights = {"jawOpen": 0.5, "mouthSmileLeft": 0.7, "mouthSmileRight": 0.7, "browInnerUp": 0.4}
    pose = show(face, Tracked(weights=tuple(weights.items())))
    other = Face(head_model())
    other.apply(SetArkit(tuple(weights.items()), 0.0))
    other.step(0.05)
    np.testing.assert_allclose(pose.array, other.pose.array, atol=1e-6)


def test_head_and_gaze_are_turned_and_others_left_alone(face):
    face.set_emotion("anger", 1.0, fade=0.0)
    face.set_head(-30.0, 0.0, fade=0.0)
    pose = show(face, Tracked(head=(0.3, 0.1, -0.1), gaze=(0.2, -0.1, 0.05)))
    found = [pose[name] for name in ("head_yaw", "head_pitch", "head_roll", "gaze_yaw", "gaze_pitch", "gaze_vergence")]
    assert found == pytest.approx([0.3, 0.1, -0.1, 0.2, -0.1, 0.05])
    assert pose["procerus_l"] > 0.5
    assert set(face.status()["drivers"]["tracker"]) == {
        "head_yaw", "head_pitch", "head_roll", "gaze_yaw", "gaze_pitch", "gaze_vergence",
    }  # fmt: skip


def test_it_holds_and_then_lets_go(face):
    face.set_head(-30.0, 0.0, fade=0.0)
    show(face, Tracked(head=(0.3, 0.0, 0.0)))
    face.step(0.4)
    assert face.pose["head_yaw"] == pytest.approx(0.3)
    face.step(0.6)
    assert face.pose["head_yaw"] == pytest.approx(math.radians(-30.0), abs=1e-5)
    assert "tracker" not in face.status()["drivers"]


def test_what_a_frame_leaves_out_is_let_go_of_without_a_jump(face):
    show(face, Tracked(expressions=(("aa", 1.0),), head=(0.3, 0.0, 0.0)))
    before = face.pose.array.copy()
    face.apply(SetTracked(Tracked(expressions=(("aa", 1.0),))))
    steps = []
    for _ in range(12):
        face.step(0.005)
        steps.append(np.abs(face.pose.array - before).max())
        before = face.pose.array.copy()
    assert face.pose["head_yaw"] == pytest.approx(0.0, abs=1e-4)
    assert face.pose["jaw_open"] > 0.3
    assert max(steps) < 0.1


def test_neutral_lets_go(face):
    show(face, Tracked(expressions=(("aa", 1.0),)))
    face.neutral(0.0)
    face.step(0.01)
    assert not face.pose.array.any()


def test_warming_up_shows_nothing(face):
    tracker_channel(face).warm_up(face.model)
    face.step(0.1)
    assert not face.pose.array.any()
    assert face.channels["tracker"] is tracker_channel(face)


@pytest.mark.parametrize(
    ("frame", "error"),
    [
        ({"weights": (("jawopen", 0.5),)}, UnknownNameError),
        ({"expressions": (("Joy", 0.5),)}, UnknownNameError),
        ({"weights": (("jawOpen", 1.5),)}, InvalidValueError),
        ({"expressions": (("happy", math.nan),)}, InvalidValueError),
        ({"head": (0.0, 2.0, 0.0)}, InvalidValueError),
        ({"gaze": (0.0, math.inf, 0.0)}, InvalidValueError),
    ],
)
def test_wrong_frames_are_refused(frame, error):
    with pytest.raises(error):
        Tracked(**frame)


def test_frames_compare_and_pickle():
    request = SetTracked(Tracked(weights=(("jawOpen", 0.5),), head=(0.1, 0.0, 0.0)))
    assert pickle.loads(pickle.dumps(request)) == request  # noqa: S301
    assert hash(request) == hash(SetTracked(Tracked(weights=(("jawOpen", 0.5),), head=(0.1, 0.0, 0.0))))


def test_every_parameter_stays_in_its_range(face):
    draw = np.random.default_rng(1)
    for _ in range(30):
        pairs = tuple((name, float(draw.uniform())) for name in PRESETS)
        weights = tuple((name, float(draw.uniform())) for name in ("jawOpen", "mouthPucker", "eyeBlinkLeft"))
        pose = show(face, Tracked(weights, pairs), 0.02)
        assert pose.array.shape == (COUNT,)
        assert 0.0 <= pose.array[indices_of("jaw_open")[0]] <= 1.0
