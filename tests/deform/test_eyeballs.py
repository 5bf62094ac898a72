"""The eyes: each aims at the point exactly, inside its elliptic hole, whatever the muscles do."""

import math

import numpy as np
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from agentface.cli import cli
from agentface.deform.eyes import eyeballs
from agentface.deform.eyes import eyeballs_compiled as compiled
from agentface.errors import InvalidValueError
from agentface.face import Face
from agentface.parameters import NAMES, PARAMETERS, FacePose, parameter
from tests.heads import deformer_of, head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
TABLES = {face: eyeballs.prepare(model) for face, model in FACES.items()}
GAZE = ("gaze_yaw", "gaze_pitch", "gaze_vergence")
ANGLES = st.tuples(*(st.floats(parameter(name).low, parameter(name).high, width=32) for name in GAZE))


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def rotations(face, angles, **others):
    pose = FacePose.of(**others).replace(dict(zip(GAZE, angles, strict=True)))
    out = np.zeros((2, 3, 3), np.float32)
    eyeballs.apply(TABLES[face], pose.array, out)
    return out


def test_level_eyes_are_not_turned(face):
    np.testing.assert_array_equal(rotations(face, (0, 0, 0)), [np.eye(3)] * 2)


@given(st.floats(-1, 1), st.floats(-1, 1), st.floats(0.12, 20))
def test_both_eyes_aim_at_the_point(across, up, ahead):
    for face, model in FACES.items():
        middle = model.eye_centre("l") * [0, 1, 1]
        point = middle + ahead * np.array([0.24 * across, 0.16 * up, 1.0])
        out = rotations(face, eyeballs.toward(model, point))
        hole = np.radians([model.eyes.yaw_limit_deg, model.eyes.pitch_limit_deg])
        for side, turn in zip("lr", out.astype(np.float64), strict=True):
            wanted = point - model.eye_centre(side)
            pitch = math.atan2(wanted[1], wanted[2])
            yaw = math.atan2(wanted[0], math.hypot(wanted[1], wanted[2]))
            looks = turn @ [0, 0, 1]
            if math.hypot(yaw / hole[0], pitch / hole[1]) < 0.999:
                assert np.linalg.norm(np.cross(looks, wanted / np.linalg.norm(wanted))) < 1e-4
            assert looks[2] > 0


def test_a_near_point_makes_the_eyes_converge_and_a_far_one_does_not(face):
    middle = FACES[face].eye_centre("l") * [0, 1, 1]
    near, far = (eyeballs.toward(FACES[face], middle + np.array([0, 0, ahead])) for ahead in (0.15, 100.0))
    half = float(FACES[face].eye_centre("l")[0])
    assert near == pytest.approx((0, 0, math.atan2(half, 0.15)), abs=1e-7)
    assert far == pytest.approx((0, 0, 0), abs=1e-3)


@given(ANGLES)
def test_no_eye_leaves_its_hole_and_none_is_held_back_inside(angles):
    for face, tables in TABLES.items():
        values = FacePose().replace(dict(zip(GAZE, angles, strict=True))).array
        for side, inward in ((0, -1), (1, 1)):
            asked = np.array([values[tables.yaw] + inward * values[tables.vergence], values[tables.pitch]], np.float64)
            hole = np.array([tables.yaw_limit, tables.pitch_limit])
            got = np.array(eyeballs.eye_angles(tables, values, side))
            assert np.linalg.norm(got / hole) <= 1 + 1e-9
            assert asked[0] * got[1] == pytest.approx(asked[1] * got[0], abs=1e-6)
            if np.linalg.norm(asked / hole) < 1:
                np.testing.assert_allclose(got, asked, atol=1e-6)
        for turn in rotations(face, angles).astype(np.float64):
            np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-6)
            assert np.linalg.det(turn) == pytest.approx(1, abs=1e-6)


@given(ANGLES)
def test_the_compiled_form_is_the_numpy_form(angles):
    values = FacePose().replace(dict(zip(GAZE, angles, strict=True))).array
    out = np.zeros((2, 3, 3), np.float32)
    for face, tables in TABLES.items():
        compiled.apply(tables, values, out)
        np.testing.assert_allclose(out, rotations(face, angles), atol=1e-7)


@given(ANGLES)
def test_mirrored_angles_turn_the_other_eye(angles):
    yaw, pitch, vergence = angles
    flip = np.diag([-1, 1, 1])
    for face in FACES:
        one, other = rotations(face, angles), rotations(face, (-yaw, pitch, vergence))
        np.testing.assert_allclose(flip @ one[0] @ flip, other[1], atol=1e-6)


def test_gaze_is_independent_of_the_muscles(face):
    muscles = {known.name: known.high for known in PARAMETERS if known.kind not in ("gaze", "head")}
    np.testing.assert_array_equal(rotations(face, (0.2, 0.1, 0.05), **muscles), rotations(face, (0.2, 0.1, 0.05)))
    assert set(GAZE) <= set(NAMES)


@pytest.mark.parametrize("point", [(0, 0, -1), (0, 0, math.nan), (0, 1), (0, "a", 1)])
def test_a_point_that_cannot_be_looked_at_is_refused(face, point):
    with pytest.raises(InvalidValueError, match="point"):
        eyeballs.toward(FACES[face], point)


def test_a_face_looks_at_a_point_and_then_afar():
    face = Face(FACES["amber"])
    face.look_at((0.1, 0.02, 0.4), fade=0.0)
    near = [face.pose[name] for name in GAZE]
    assert near == pytest.approx(eyeballs.toward(FACES["amber"], (0.1, 0.02, 0.4)), abs=1e-6)
    face.look_at((0.0, 5.0, 0.3), fade=0.0)
    assert face.pose["gaze_pitch"] == pytest.approx(0.98 * parameter("gaze_pitch").high)
    face.set_gaze(10, 0, fade=0.0)
    assert face.pose["gaze_vergence"] == 0
    with pytest.raises(InvalidValueError, match="point"):
        face.look_at((0, 0, -0.5))


def test_a_picture_is_drawn_of_a_face_that_looks_at_a_point(monkeypatch, tmp_path):
    seen = []
    monkeypatch.setattr(
        Face, "render", lambda self, *_args, **_named: seen.append(self.pose) or np.zeros((2, 2, 3), np.uint8)
    )
    target = str(tmp_path / "face.png")
    done = CliRunner().invoke(cli, ["render", "--look-at", "0.05,0,0.3", "-o", target])
    assert done.exit_code == 0, done.output
    assert seen[0]["gaze_vergence"] > 0.05
    assert CliRunner().invoke(cli, ["render", "--look-at", "0.05,0", "-o", target]).exit_code == 2


@pytest.mark.parametrize("compiled", [True, False])
def test_an_eye_comes_out_and_its_pupil_grows_by_equal_factors(compiled):
    deformer = deformer_of(compiled=compiled)
    for value in (-1.0, -0.5, 0.0, 0.25, 1.0):
        geometry = deformer.at(FacePose().replace({"eye_thrust_l": value, "pupil_dilation_r": value}))
        np.testing.assert_allclose(geometry.eye_thrust, [0.002 * value, 0.0], atol=1e-9)
        np.testing.assert_allclose(geometry.pupils, [1.0, 2.0**value], rtol=1e-6)
    third = 1 / 3
    assert 0.1 < third * 0.5 < third * 2.0 < 0.8, "a pupil is 2 to 8 mm wide, an iris 12"
