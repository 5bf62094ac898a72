"""The 84 feature points on both faces: where the standard says that they are."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from agentface.errors import DataError, InvalidValueError, UnknownNameError
from agentface.head.feature_points import FEATURE_POINTS
from agentface.head.landmarks import read_landmarks
from agentface.head.resample import subdivided, thinned
from agentface.head.ring_names import LidRing, LipRing
from agentface.mpeg4.fapu import PARTS, fapu
from agentface.mpeg4.feature_points import absent_points, feature_point, feature_points
from agentface.resources import face_folder, face_names
from tests.heads import head_model

RIGHT = {
    "2.4": "2.5", "2.6": "2.7", "2.8": "2.9", "2.11": "2.12", "2.13": "2.14", "3.1": "3.2", "3.3": "3.4", "3.5": "3.6",
    "3.7": "3.12", "3.9": "3.10", "3.11": "3.8", "3.13": "3.14", "4.1": "4.2", "4.3": "4.4", "4.5": "4.6",
    "5.1": "5.2", "5.3": "5.4", "6.3": "6.4", "8.3": "8.4", "8.5": "8.6", "8.7": "8.8", "8.10": "8.9", "9.1": "9.2",
    "9.5": "9.4", "9.7": "9.6", "9.13": "9.14", "10.1": "10.2", "10.3": "10.4", "10.5": "10.6", "10.7": "10.8",
    "10.9": "10.10", "11.3": "11.2",
}  # fmt: skip


@pytest.mark.parametrize("face", face_names())
def test_all_but_the_hair_s_thickness_are_there(face):
    model = head_model(face)
    assert len(FEATURE_POINTS) == len(model.feature_points) == 84
    assert set(absent_points(model)) == {"11.5"}
    assert "hair" in absent_points(model)["11.5"]
    assert len(feature_points(model)) == 83


@pytest.mark.parametrize("face", face_names())
def test_left_and_right_are_each_other_s_images(face):
    points = feature_points(head_model(face))
    for left, right in RIGHT.items():
        np.testing.assert_allclose(points[left].position, points[right].position * [-1, 1, 1], atol=2e-4)
        assert points[left].position[0] > 0.003
    middle = points.keys() - RIGHT.keys() - set(RIGHT.values())
    # the first incisors lie beside the middle
    assert {number for number in middle if abs(points[number].position[0]) > 5e-4} == set()


@pytest.mark.parametrize("face", face_names())
def test_points_lie_as_the_standard_orders_them(face):
    at = {number: point.position for number, point in feature_points(head_model(face)).items()}
    down = ("11.4", "11.1", "4.1", "3.13", "3.1", "3.5", "3.3", "3.9", "9.3", "9.15", "8.1", "2.2")
    assert all(at[above][1] > at[below][1] for above, below in pairwise(down))
    assert at["2.2"][1] >= at["2.3"][1] > at["8.2"][1] > at["2.10"][1] > at["2.1"][1]
    across = ("8.3", "8.5", "8.10", "8.1", "8.9", "8.6", "8.4")
    assert all(at[left][0] > at[right][0] for left, right in pairwise(across))
    assert at["8.3"][0] > at["2.4"][0] > at["2.6"][0] > at["2.2"][0] + 0.003
    assert at["9.12"][1] < at["9.7"][1]
    assert at["9.12"][1] > at["9.3"][1]
    ear = {number: at[number] for number in ("10.1", "10.3", "10.5", "10.7", "10.9")}
    assert max(ear, key=lambda number: ear[number][1]) == "10.1"
    assert min(ear, key=lambda number: ear[number][1]) == "10.5"
    assert min(ear, key=lambda number: ear[number][2]) == "10.3"
    assert at["10.7"][1] < at["10.9"][1]
    assert at["6.1"][2] > at["6.2"][2]
    assert at["6.3"][0] > at["6.2"][0] > at["6.4"][0]
    assert at["9.8"][1] > at["9.10"][1] > at["9.11"][1] > at["9.9"][1]
    assert at["11.6"][2] < at["11.4"][2] < at["11.1"][2]


@pytest.mark.parametrize("face", face_names())
def test_lips_and_lids_are_points_of_their_rings(face):
    model = head_model(face)
    vertex = {number: point.vertex for number, point in feature_points(model).items()}
    for ring, numbers in (
        (LipRing.CONTACT, ("2.2", "2.3", "2.4", "2.5", "2.6", "2.7", "2.8", "2.9")),
        (LipRing.BORDER, ("8.1", "8.2", "8.3", "8.4", "8.5", "8.6", "8.7", "8.8", "8.9", "8.10")),
    ):
        halves = model.lips.rings[ring]
        assert {vertex[number] for number in numbers} <= {*halves.upper, *halves.lower}
        assert {vertex[numbers[2]], vertex[numbers[3]]} == {halves.upper[0], halves.upper[-1]}
    edge = model.eyelids.rings["l"][LidRing.EDGE]
    assert vertex["3.1"] in edge.upper
    assert vertex["3.3"] in edge.lower
    assert {vertex["3.7"], vertex["3.11"]} == {edge.upper[0], edge.upper[-1]}


@pytest.mark.parametrize("face", face_names())
def test_units_are_a_1024th_of_a_face(face):
    model = head_model(face)
    units = fapu(model)
    at = {number: point.position.astype(float) for number, point in feature_points(model).items()}
    assert pytest.approx(model.landmarks.eye_separation, abs=1e-6) == units.ES * PARTS
    assert pytest.approx(np.linalg.norm(at["8.3"] - at["8.4"]), rel=1e-4) == units.MW * PARTS
    assert pytest.approx(at["3.5"][1] - at["9.15"][1], abs=1e-6) == units.ENS * PARTS
    assert pytest.approx(at["9.15"][1] - at["2.2"][1], abs=1e-6) == units.MNS * PARTS
    assert pytest.approx(at["3.1"][1] - at["3.3"][1], abs=1e-6) == units.IRISD * PARTS
    # a face's proportions: an eye's opening is less than the nose's and the mouth's distances
    assert 0.008 < units.IRISD * PARTS < 0.013 < units.MNS * PARTS < units.ENS * PARTS < units.ES * PARTS * 1.05
    assert units.of("AU") == 1e-5
    assert units.of("none") == 1.0


def test_a_point_is_asked_for_by_number():
    model = head_model()
    assert feature_point(model, "8.3").vertex == model.lips.rings[LipRing.BORDER].upper[0]
    with pytest.raises(UnknownNameError, match=r"12\.1"):
        feature_point(model, "12.1")
    with pytest.raises(InvalidValueError, match="hair"):
        feature_point(model, "11.5")


def test_points_stay_where_they_are_on_a_finer_and_a_coarser_mesh():
    model = head_model()
    for other in (subdivided(model), thinned(model, 5000)):
        points = feature_points(other)
        for number, point in feature_points(model).items():
            assert np.array_equal(points[number].position, point.position)
        assert absent_points(other).keys() == absent_points(model).keys()


def test_every_fault_of_the_points_is_told(tmp_path):
    text = (face_folder("amber") / "feature_points.yaml").read_text()
    for old, new in (
        ("'2.10': {vertex: 197}", "'2.15': {vertex: 197}"),
        ("'3.5': {place: pupil_l}", "'3.5': {place: pupil_l, vertex: 3}"),
        ("'4.1': {vertex: 4897}", "'4.1': {}"),
    ):
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "feature_points.yaml"
    path.write_text(text)
    with pytest.raises(DataError) as caught:
        read_landmarks(path, 10_000)
    assert {fault.where for fault in caught.value.faults} == {"feature_points.3.5", "feature_points.4.1"}
    path.write_text(text.replace(", vertex: 3}", "}").replace("'4.1': {}", "'4.1': {vertex: 4897}"))
    with pytest.raises(DataError) as caught:
        read_landmarks(path, 4800)
    wheres = [fault.where for fault in caught.value.faults]
    assert "feature_points" in wheres
    assert "feature_points.2.15" in wheres
    assert "feature_points.4.1.vertex" in wheres
