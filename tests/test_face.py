from __future__ import annotations

import copy
import json
import math
import pickle
import shutil
import subprocess
import sys

import numpy as np
import pytest

import agentface
from agentface import AgentFaceError, EmotionState, Face, FacePose
from agentface.arkit.shape_solver import ShapeSolver
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.model import load_model
from agentface.mpeg4.fap_solver import FapSolver
from tests.clocks import ManualClock
from tests.deform.jelly import Jelly
from tests.heads import head_model

KEYS = [
    "face", "emotion", "mood", "shown", "action_units", "drivers", "state", "liveliness",
    "speech", "gaze_deg", "frame_ms", "messages", "errors",
]  # fmt: skip


@pytest.fixture(scope="module")
def model():
    return head_model()


@pytest.fixture
def face(model):
    return Face(model)


def test_an_emotion_moves_the_face_and_neutral_brings_it_back(face):
    rest = face.step(0.0).vertices.copy()
    face.set_emotion("happiness", 0.8)
    first = face.step(1e-3).vertices.copy()
    there = face.step(1.0).vertices.copy()
    assert np.abs(first - rest).max() < 1e-5
    assert 2e-3 < np.linalg.norm(there - rest, axis=1).max() < 0.04
    face.neutral(0.1)
    np.testing.assert_array_equal(face.step(0.2).vertices, rest)


def test_another_deformer_takes_over_where_it_stands(face):
    other = Jelly(face.model)
    face.set_muscle("jaw_open", 1.0, fade=0.0)
    shown = face.step(1.0).vertices.copy()
    face.take_deformer(other)
    assert face.deformer is other
    np.testing.assert_array_equal(face.geometry.vertices, shown)
    assert np.abs(face.step(1e-3).vertices - shown).max() > 1e-3, "it stood at rest"
    face.step(100.0)
    np.testing.assert_allclose(face.geometry.vertices, shown, atol=1e-6)


def test_one_name_leaves_the_other_emotions_and_a_mapping_does_not(face):
    face.set_emotion("anger", 0.4)
    face.set_emotion("joy", 0.5)
    assert face.emotion == EmotionState.of(anger=0.4, happiness=0.5)
    face.set_emotion({"fear": 0.3})
    assert face.emotion == EmotionState.of(fear=0.3)
    face.neutral()
    assert face.emotion == EmotionState()


def test_hold_brings_a_whole_state_back(face):
    face.set_emotion({"happiness": 0.6, "surprise": 0.4}, fade=0.3, hold=2.0)
    face.step(2.2)
    assert face.status()["emotion"]["happiness"] == 0.6
    face.step(0.5)
    assert face.pose == FacePose()


@pytest.mark.parametrize(
    "call",
    [
        lambda face: face.set_emotion("hapiness", 0.5),
        lambda face: face.set_emotion("happiness", 1.2),
        lambda face: face.set_emotion("happiness", math.nan),
        lambda face: face.set_emotion("happiness", None),
        lambda face: face.set_emotion("happiness", True),
        lambda face: face.set_emotion("happiness", 0.5, fade=-1),
        lambda face: face.set_emotion("happiness", 0.5, fade=math.inf),
        lambda face: face.set_emotion("happiness", 0.5, hold=-0.1),
        lambda face: face.set_emotion({"happiness": 0.5}, 0.5),
        lambda face: face.set_emotion({"fear": 0.5, "nothing": 0.5}),
        lambda face: face.set_emotion({"joy": 0.5, "happy": 0.5}),
        lambda face: face.set_emotion(None, 0.5),
        lambda face: face.set_muscle("biceps", 0.5),
        lambda face: face.set_muscle("gaze_yaw", 0.5),
        lambda face: face.set_muscle("zygomaticus_major", -0.1),
        lambda face: face.set_jaw(2),
        lambda face: face.set_gaze(51, 0),
        lambda face: face.set_gaze(0, math.nan),
        lambda face: face.set_head(0, 0, "left"),
        lambda face: face.neutral(-1),
        lambda face: face.step(-0.1),
        lambda face: face.step(math.nan),
    ],
)
def test_a_wrong_call_changes_nothing(face, call):
    face.set_emotion("sadness", 0.4)
    face.set_muscle("risorius", 0.3)
    face.step(0.1)
    before = face.status() | {"frame_ms": 0}
    with pytest.raises((UnknownNameError, InvalidValueError)):
        call(face)
    assert face.status() | {"frame_ms": 0} == before
    face.step(1.0)
    assert face.emotion == EmotionState.of(sadness=0.4)


def test_the_same_calls_give_the_same_frames(model):
    def film():
        face = Face(model, seed=7)
        for frame in range(40):
            if frame % 7 == 0:
                face.set_emotion("fear" if frame % 2 else "anger", frame / 40)
            if frame == 9:
                face.blink()
                face.set_gaze(10, -5)
            yield face.step(1 / 30).vertices.copy()

    for one, other in zip(film(), film(), strict=True):
        np.testing.assert_array_equal(one, other)


def test_single_muscles_jaw_gaze_and_head_reach_the_pose(face):
    face.set_muscle("corrugator_supercilii", 0.7, fade=0.0)
    face.set_jaw(0.4, fade=0.0)
    face.set_gaze(20, -10, fade=0.0)
    face.set_head(-30, 5, 10, fade=0.0)
    pose = face.pose
    assert pose["corrugator_supercilii_l"] == pose["corrugator_supercilii_r"] == pytest.approx(0.7)
    assert pose["jaw_open"] == pytest.approx(0.4)
    assert math.degrees(pose["gaze_yaw"]) == pytest.approx(20, abs=1e-4)
    assert math.degrees(pose["head_yaw"]) == pytest.approx(-30, abs=1e-4)
    face.set_muscle("corrugator_supercilii", None, fade=0.0)
    assert face.pose["corrugator_supercilii_l"] == 0.0


@pytest.mark.parametrize("sign", [-1, 1])
def test_the_furthest_turns_are_taken_and_drawn(face, sign):
    face.set_gaze(sign * 50, sign * 40, fade=0.0)
    face.set_head(sign * 80, sign * 60, sign * 50, fade=0.0)
    face.step(0.1)
    turned = [face.turned_deg[name] for name in ("gaze_yaw", "gaze_pitch", "head_yaw", "head_pitch", "head_roll")]
    assert turned == [sign * limit for limit in (50, 40, 80, 60, 50)]


def test_the_pose_is_fresh_without_a_step(face):
    face.set_emotion({"disgust": 1.0}, fade=0.0)
    assert face.pose["levator_labii_superioris_alaeque_nasi_l"] > 0.5
    assert face.status()["shown"]["emotion"]["disgust"] == 1.0


def test_status_has_exactly_its_keys_and_is_json(model):
    face = Face(model, clock=ManualClock())
    face.set_emotion({"fear": 0.5, "surprise": 0.25}, fade=0.5)
    face.set_gaze(12, 3, fade=0.0)
    face.step(0.25)
    status = json.loads(json.dumps(face.status(), allow_nan=False))
    assert list(status) == KEYS
    assert status["face"] == "amber"
    assert status["emotion"] == {
        "happiness": 0, "sadness": 0, "anger": 0, "fear": 0.5, "disgust": 0, "surprise": 0.25,
    }  # fmt: skip
    assert 0.1 < status["shown"]["emotion"]["fear"] < 0.4
    assert not any(status["mood"].values())
    assert 0 < status["shown"]["contractions"]["risorius_l"] < 1
    assert status["gaze_deg"] == pytest.approx([12, 3], abs=1e-3)
    assert status["frame_ms"] == 0.0
    assert status["messages"] == 0
    assert status["errors"] == {"malformed": 0, "unknown": 0, "rejected": 0}


def test_faces_and_deformers_are_checked():
    with pytest.raises(UnknownNameError, match="did you mean amber"):
        Face("ambre")
    with pytest.raises(UnknownNameError, match="geometric"):
        Face(deformer="jelly")
    assert Face("onyx").status()["face"] == "onyx"


@pytest.mark.gl
def test_render_shows_the_emotion(face):
    neutral = face.render((160, 120))
    assert neutral.shape == (120, 160, 3)
    assert neutral.dtype == np.uint8
    face.set_emotion("surprise", 1.0, fade=0.0)
    surprised = face.render((160, 120))
    assert np.abs(surprised.astype(int) - neutral).max() > 40
    face.neutral(0.0)
    np.testing.assert_array_equal(face.render((160, 120)), neutral)


def test_public_names_are_lazy_and_complete():
    script = (
        "import sys, agentface\n"
        "heavy = {'numba', 'scipy', 'skfuzzy', 'moderngl', 'PIL', 'av', 'pydantic', 'yaml', 'click', 'rich'}\n"
        "assert not heavy & set(sys.modules), heavy & set(sys.modules);"
        "assert set(agentface.__all__) <= set(dir(agentface));"
        "[getattr(agentface, name) for name in agentface.__all__];"
        "assert not {'moderngl', 'skfuzzy', 'av'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", script], check=True, timeout=240)
    assert issubclass(UnknownNameError, AgentFaceError)
    with pytest.raises(AttributeError):
        _ = agentface.Fase


def test_warming_up_changes_nothing_that_is_shown():
    face = Face()
    face.set_emotion("fear", 0.6, fade=0.0)
    before = face.geometry.vertices.copy()
    face.warm_up()
    assert face.emotion["fear"] == 0.6
    np.testing.assert_array_equal(face.geometry.vertices, before)


def test_solvers_are_warmed_up_when_they_are_asked_for(face, monkeypatch):
    solved = []
    monkeypatch.setattr(FapSolver, "solve", lambda *_: solved.append("faps"))
    monkeypatch.setattr(ShapeSolver, "solve_named", lambda *_: solved.append("weights"))
    face.warm_up()
    assert solved == []
    face.warm_up(solvers=True)
    assert solved == ["faps", "weights"]


@pytest.mark.gl
def test_a_kept_pose_is_drawn_without_changing_the_face():
    face = Face()
    neutral = face.pose
    plain = face.render((96, 64))
    face.set_emotion("surprise", 1.0, fade=0.0)
    shown = face.render((96, 64))
    np.testing.assert_array_equal(face.render((96, 64), pose=neutral), plain)
    np.testing.assert_array_equal(face.render((96, 64)), shown)
    assert (plain != shown).any()


def test_without_the_compiler_the_face_is_the_same(model):
    state = {"happiness": 0.7, "surprise": 0.4, "fear": 0.2}
    one, other = Face(model), Face(model, compiled=False)
    for face in (one, other):
        face.set_emotion(state, fade=0.0)
    np.testing.assert_allclose(one.geometry.vertices, other.geometry.vertices, atol=1e-6)
    np.testing.assert_allclose(one.geometry.normals, other.geometry.normals, atol=2e-3)


@pytest.mark.slow
@pytest.mark.gl
def test_a_picture_from_the_command_line_needs_no_compiler(tmp_path):
    code = (
        "import sys; from agentface.commands.render import render; import contextlib\n"
        f"with contextlib.suppress(SystemExit): render(['--emotion', 'fear=1', '-o', {str(tmp_path / 'a.png')!r}])\n"
        "print('numba' in sys.modules)"
    )
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert said.strip() == "False"


@pytest.mark.gl
def test_a_geometry_holds_until_the_face_s_next_step_whatever_else_is_asked(face):
    face.set_emotion("happiness", 1.0, fade=0.0)
    held = face.step(0.1)
    kept = held.copy()
    face.render((64, 48), pose=FacePose())
    face.warm_up()
    face.set_emotion("anger", 1.0, fade=0.0)
    assert face.geometry != kept
    Face(face.model).step(0.1)
    assert held == kept
    face.step(0.1)
    assert held != kept


def test_a_face_says_that_it_cannot_be_copied_or_pickled(face):
    for call in (pickle.dumps, copy.copy, copy.deepcopy):
        with pytest.raises(TypeError, match="make another Face of the same model"):
            call(face)


@pytest.mark.gl
def test_a_closed_face_draws_no_more():
    with Face("amber", compiled=False) as face:
        face.render((64, 48))
    face.close()
    with pytest.raises(InvalidValueError, match="closed"):
        face.render((64, 48))


def test_faces_read_their_model_once_while_its_files_stay(tmp_path):
    folder = tmp_path / "mine"
    shutil.copytree(load_model("amber").folder, folder)
    first = load_model(folder)
    assert Face(folder).model is first
    assert load_model(folder, asymmetry=0.0) is not first
    with (folder / "jaw.yaml").open("a") as file:
        file.write("# changed\n")
    assert load_model(folder) is not first
