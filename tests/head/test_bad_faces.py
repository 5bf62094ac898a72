"""Every fault of a face's files is told, and nothing is half loaded."""

import shutil

import numpy as np
import pytest

from agentface.errors import DataError, UnknownNameError
from agentface.head.model import load_model
from agentface.mesh.glb import read_glb, write_glb
from agentface.resources import face_folder


@pytest.fixture
def face(tmp_path):
    return shutil.copytree(face_folder("amber"), tmp_path / "mine")


def edit(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))


def faults_of(face):
    with pytest.raises(DataError) as caught:
        load_model(face)
    return caught.value.faults


def test_a_copied_face_loads_by_path(face):
    assert load_model(face).name == "mine"


def test_unknown_faces_name_the_known_ones():
    with pytest.raises(UnknownNameError, match="did you mean amber"):
        load_model("ambre")


@pytest.mark.parametrize(
    ("old", "new", "expected"), [("[0, ", "[1, ", "no gap"), ("vertices: 6", "vertices: 7", "as in head.glb")]
)
def test_regions_must_cover_the_mesh(face, old, new, expected):
    edit(face / "regions.yaml", old, new)
    faults = faults_of(face)
    assert any(expected in fault.expected for fault in faults)
    assert all(fault.line for fault in faults)


def test_overlapping_regions_are_told(face):
    model = load_model(face)
    first, last = model.regions.ranges["middle_face_r"]
    edit(face / "regions.yaml", f"middle_face_r: [{first}, {last}]", f"middle_face_r: [{first - 5}, {last}]")
    assert any("no overlap" in fault.expected for fault in faults_of(face))


def test_all_faults_of_the_muscles_at_once(face):
    path = face / "muscles.yaml"
    edit(path, "  risorius:", "  risoriusx:")
    edit(path, "at: brow_inner", "at: elbow")
    edit(path, "[upper_face]", "[upper_farce]")
    edit(path, "zone_deg: ", "zone_deg: .nan  #")
    edit(path, "falloff: smooth", "falloff: smooth\nfalloff: waters")
    where = [fault.where for fault in faults_of(face)]
    assert "muscles.risoriusx" in where
    assert "muscles" in where  # risorius is missing
    assert "muscles.frontalis_medialis.zone_deg" in where
    assert "falloff" in where
    assert "muscles.frontalis_medialis.insertion.at" in where
    assert "muscles.frontalis_medialis.regions.0" in where


def test_a_landmark_off_the_mesh_is_told(face):
    edit(face / "feature_points.yaml", "vertices: [", "vertices: [99999, ")
    (fault,) = faults_of(face)
    assert "vertices in 0.." in fault.expected


def test_a_mesh_with_nan_is_refused(face):
    path = face / "head.glb"
    seventh = load_model(face).vertices[7].tobytes()
    content = path.read_bytes()
    assert content.count(seventh) == 1
    path.write_bytes(content.replace(seventh, np.full(3, np.nan, np.float32).tobytes()))
    (fault,) = faults_of(face)
    assert "finite" in fault.expected


@pytest.mark.parametrize(
    "content", [b"", b"glTF", b"\x00" * 5000, b"glTF\x02\x00\x00\x00\xff\xff\xff\xff\xff\xff\xff\x7fJSON{}"]
)
def test_rubbish_instead_of_a_mesh_is_one_fault(face, content):
    (face / "head.glb").write_bytes(content)
    (fault,) = faults_of(face)
    assert "GLB" in fault.expected


def test_what_is_written_is_read_back(tmp_path):
    meshes = read_glb(face_folder("amber") / "head.glb")
    write_glb(tmp_path / "again.glb", meshes, "test")
    again = read_glb(tmp_path / "again.glb")
    assert again.keys() == meshes.keys()
    for name, mesh in meshes.items():
        np.testing.assert_array_equal(again[name].triangles, mesh.triangles)
        for key, array in mesh.attributes.items():
            np.testing.assert_array_equal(again[name].attributes[key], array)
        for key, shape in mesh.shapes.items():
            np.testing.assert_array_equal(again[name].shapes[key].offsets, shape.offsets)
