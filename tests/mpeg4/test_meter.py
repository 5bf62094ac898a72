"""What is read off a face: points that were moved by known amounts, bones, angles, wrinkles."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.deform.geometry import FaceGeometry
from agentface.errors import InvalidValueError
from agentface.mpeg4.fap_readings import CHIN, EYES, HEAD, JAW
from agentface.mpeg4.faps import FAPS, LOW_LEVEL, fap
from agentface.mpeg4.fapu import fapu
from agentface.mpeg4.feature_points import feature_points
from agentface.mpeg4.meter import FapMeter
from agentface.parameters import HIGH, LOW, FacePose, parameter
from agentface.resources import face_names
from tests.heads import deformer_of, head_model
from tests.mpeg4.solvers import some_poses

DIRECTION = {
    "left": (1, 0, 0), "right": (-1, 0, 0), "up": (0, 1, 0), "down": (0, -1, 0), "forward": (0, 0, 1),
}  # fmt: skip
ON_SKIN = [
    each for each in LOW_LEVEL
    if each.group not in (6, 7) and each.number not in (*JAW, CHIN, *range(23, 31))
]  # fmt: skip


def at_rest(face="amber"):
    model = head_model(face)
    return FaceGeometry.at_rest(model)


@pytest.mark.parametrize("face", face_names())
def test_a_face_at_rest_shows_nothing(face):
    assert not FapMeter(head_model(face)).measure(at_rest(face)).any()
    assert not FapMeter(head_model(face)).measure(deformer_of(face).at(FacePose())).any()


@pytest.mark.parametrize("known", ON_SKIN, ids=lambda each: str(each.number))
def test_a_point_moved_by_its_unit_shows_its_value(known):
    model, geometry = head_model(), at_rest()
    (number,) = known.points
    vertex = feature_points(model)[number].vertex
    way = 100 * fapu(model).of(known.unit) * np.array(DIRECTION[known.positive])
    geometry.vertices[vertex] += way.astype(np.float32)
    shown = FapMeter(model).measure(geometry)
    assert shown[known.number - 1] == pytest.approx(100, abs=0.01)
    others = {each.number for each in FAPS if each.points == known.points} - {known.number}
    assert set(np.flatnonzero(np.abs(shown) > 0.01) + 1) <= {known.number}, others


def test_wrinkles_move_no_point():
    geometry = at_rest()
    geometry.wrinkles[:] = 1e-3
    geometry.vertices += geometry.wrinkles[:, None] * geometry.smooth_normals
    assert np.abs(FapMeter(head_model()).measure(geometry)).max() < 0.01


def test_the_jaw_is_read_off_its_bone():
    model = head_model()
    meter, points = FapMeter(model), feature_points(model)
    shown = meter.measure(deformer_of().at(FacePose.of(jaw_open=0.5)))
    angle = np.radians(0.5 * model.jaw.widest_deg)
    up, ahead = points["2.1"].position[1:].astype(float) - model.jaw.pivot[1:]
    down = up - (np.cos(angle) * up - np.sin(angle) * ahead)
    assert shown[2] == pytest.approx(down / meter.units.MNS, rel=1e-4)
    assert np.abs(shown[[13, 14]]).max() < 0.01
    assert abs(shown[17]) < 0.03 * shown[2], "the chin goes with the bone"
    slid = at_rest()
    slid.jaw[:3, 3] = 0.002, 0.0, 0.003
    shown = meter.measure(slid)
    assert shown[13] == pytest.approx(0.003 / meter.units.MNS, rel=1e-4)
    assert shown[14] == pytest.approx(-0.002 / meter.units.MW, rel=1e-4)


@pytest.mark.parametrize(
    ("name", "numbers", "sign"),
    [
        ("head_yaw", (49,), 1), ("head_pitch", (48,), -1), ("head_roll", (50,), -1),
        ("gaze_yaw", (23, 24), 1), ("gaze_pitch", (25, 26), -1),
    ],
)  # fmt: skip
def test_angles_come_back(name, numbers, sign):
    value = 0.12
    shown = FapMeter(head_model()).measure(deformer_of().at(FacePose.of(**{name: value})))
    for number in (*EYES, *HEAD):
        expected = sign * value * 1e5 if number in numbers else 0.0
        assert shown[number - 1] == pytest.approx(expected, abs=1.0)


def test_a_turned_head_moves_no_point_of_its_face():
    pose = FacePose.of(head_yaw=0.8, head_pitch=-0.5, head_roll=0.3)
    shown = FapMeter(head_model()).measure(deformer_of().at(pose))
    assert set(np.flatnonzero(np.abs(shown) > 0.01) + 1) == set(HEAD)


def test_the_tongue_is_read_in_the_jaw_s_frame():
    model, geometry = head_model(), at_rest()
    meter, points = FapMeter(model), feature_points(model)
    geometry.tongue[points["6.1"].vertex] += np.array([-0.001, 0.002, 0.003], np.float32)
    geometry.tongue[points["6.2"].vertex, 1] += 0.001
    geometry.jaw[:3, 3] = 0.0, -0.02, 0.0
    shown = meter.measure(geometry)
    units = meter.units
    expected = (0.001 / units.MW, 0.002 / units.MNS, 0.003 / units.MW, 0.001 / units.MNS)
    np.testing.assert_allclose(shown[42:46], expected, rtol=1e-3)


def test_a_rolled_tongue_shows_the_angle_of_its_borders():
    model, geometry = head_model(), at_rest()
    meter, points = FapMeter(model), feature_points(model)
    left, right, middle = (points[number] for number in ("6.3", "6.4", "6.2"))
    half = 0.5 * (left.position[0] - right.position[0])
    before = 0.5 * (left.position[1] + right.position[1]) - middle.position[1]
    for side in (left, right):
        geometry.tongue[side.vertex, 1] += half - before
    angle = np.arctan2(half, half) - np.arctan2(before, half)
    assert meter.measure(geometry)[46] == pytest.approx(angle * 1e5, rel=1e-4)


def test_pupils_and_eyeballs_show_what_they_do():
    geometry = at_rest()
    geometry.pupils[:] = 1.5, 0.5
    geometry.eye_thrust[:] = 0.001, -0.002
    meter = FapMeter(head_model())
    shown = meter.measure(geometry)
    # a pupil at rest is a third of the iris, which counts 1024
    np.testing.assert_allclose(shown[28:30], [1024 / 6, -1024 / 6], rtol=1e-5)
    np.testing.assert_allclose(shown[26:28], np.array([0.001, -0.002]) / meter.units.ES, rtol=1e-5)


def test_eyes_that_converge_look_inward():
    shown = FapMeter(head_model()).measure(deformer_of().at(FacePose.of(gaze_vergence=0.1)))
    assert shown[22] == pytest.approx(-1e4, abs=1.0)
    assert shown[23] == pytest.approx(1e4, abs=1.0)


@pytest.mark.parametrize("face", face_names())
def test_a_mirrored_face_shows_mirrored_faps(face):
    meter = FapMeter(head_model(face))
    poses = some_poses("uniform", 3, 5)
    for values in poses:
        pose = FacePose(values)
        image = FacePose(_mirrored(values))
        one, other = (meter.measure(deformer_of(face).at(each)) for each in (pose, image))
        for known in LOW_LEVEL:
            name = known.name.replace("_l_", "_?_").replace("_r_", "_l_").replace("_?_", "_r_")
            name = name.replace("_lip_lm", "_lip_?m").replace("_lip_rm", "_lip_lm").replace("_lip_?m", "_lip_rm")
            sign = -1 if known.name in ("shift_jaw", "bend_nose", "shift_tongue_tip", "head_yaw", "head_roll") else 1
            sign = -1 if "yaw" in known.name else sign
            # the tongue's mesh is not quite its own image: its roll is in AU, 1e-5 rad
            near = {43: 2.0, 44: 2.0, 45: 2.0, 46: 2.0, 47: 200.0}.get(known.number, 0.5)
            assert other[fap(name).number - 1] == pytest.approx(sign * one[known.number - 1], abs=near), known.name


def _mirrored(values):
    result = values.copy()
    for index, value in enumerate(values):
        known = parameter(_names()[index])
        if known.partner:
            result[parameter(known.partner).index] = value
        elif known.sideways:
            result[index] = -value
    return np.clip(result, LOW, HIGH)


def _names():
    from agentface.parameters import NAMES

    return NAMES


def test_many_faces_are_measured_as_each_alone_and_as_by_numpy():
    model, poses = head_model(), some_poses("natural", 6, 2)
    faces = [deformer_of().at(FacePose(values)) for values in poses]
    batch = FaceGeometry(*(np.stack(arrays) for arrays in zip(*(face.arrays() for face in faces), strict=True)))
    meter, plain = FapMeter(model), FapMeter(model, compiled=False)
    shown = meter.measure(batch)
    assert shown.shape == (6, 68)
    assert shown.dtype == np.float32
    np.testing.assert_array_equal(shown, np.stack([meter.measure(face) for face in faces]))
    np.testing.assert_allclose(plain.measure(batch), shown, atol=1e-3)
    square = FaceGeometry(*(array.reshape(2, 3, *array.shape[1:]) for array in batch.arrays()))
    np.testing.assert_array_equal(meter.measure(square), shown.reshape(2, 3, 68))


def test_another_mesh_is_refused():
    geometry = at_rest()
    geometry.vertices = geometry.vertices[:-1]
    with pytest.raises(InvalidValueError, match="vertices of amber"):
        FapMeter(head_model()).measure(geometry)
