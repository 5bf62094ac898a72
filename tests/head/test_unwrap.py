"""Texture coordinates: those of the file, exactly; otherwise the skin spread out flat, folded only where it hides."""

import shutil
from dataclasses import replace

import numpy as np
import pygltflib
import pytest
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st

from agentface.cli import cli
from agentface.errors import DataError
from agentface.head.model import load_model
from agentface.head.resample import subdivided
from agentface.head.ring_names import LidRing
from agentface.head.unwrap import unwrap, unwrap_centre, unwrap_cover
from agentface.mesh.glb import read_glb, write_glb
from agentface.resources import face_folder, face_names
from tests.heads import head_model

FACES = face_names()
CENTRE = np.array([0.0, -0.03, -0.01])


@pytest.fixture
def face(tmp_path):
    return shutil.copytree(face_folder("amber"), tmp_path / "mine")


def textured(face, coordinates):
    """Give the face these texture coordinates; the document, to be changed further."""
    meshes = read_glb(face / "head.glb")
    vertices = len(meshes["skin"].attributes["POSITION"])
    meshes["skin"].attributes["TEXCOORD_0"] = np.resize(coordinates, (vertices, *coordinates.shape[1:]))
    write_glb(face / "head.glb", meshes, "test")
    document = pygltflib.GLTF2().load_binary(str(face / "head.glb"))
    (skin,) = [mesh for mesh in document.meshes if mesh.name == "skin"]
    accessor = document.accessors[skin.primitives[0].attributes.TEXCOORD_0]
    if len(coordinates) != vertices:
        accessor.count = len(coordinates)
        document.save_binary(str(face / "head.glb"))
    return document, accessor


def some_coordinates():
    return np.random.default_rng(5).random((len(head_model("amber").vertices), 2), np.float32)


def areas(model):
    """``(T,)`` signed areas in the picture, above 0 where a triangle lies as it is seen from outside."""
    a, b, c = (model.uv[model.triangles[:, i]].astype(float) for i in range(3))
    return 0.5 * ((b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]) - (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]))


@pytest.mark.parametrize("name", FACES)
def test_the_face_lies_in_the_picture_and_its_sides_are_mirror_images(name):
    model = head_model(name)
    assert model.uv.shape == (len(model.vertices), 2)
    assert model.uv.dtype == np.float32
    assert model.uv.min() >= 0.0
    assert model.uv.max() <= 1.0
    image = model.uv[model.mirror] * np.float32([-1, 1]) + np.float32([1, 0])
    np.testing.assert_allclose(model.uv, image, atol=1e-6)


@pytest.mark.parametrize("name", FACES)
def test_the_person_s_left_is_at_the_right_and_the_forehead_on_top(name):
    model = head_model(name)

    def at(landmark):
        return model.uv[np.linalg.norm(model.vertices - model.landmarks[landmark], axis=1).argmin()]

    assert at("mouth_corner_l")[0] > 0.55 > 0.45 > at("mouth_corner_r")[0]
    rows = [at(name)[1] for name in ("hairline_middle", "glabella", "nose_tip", "upper_lip_middle", "menton")]
    assert rows == sorted(rows)
    assert at("ear_front_l")[0] < 0.9


@pytest.mark.parametrize("name", FACES)
def test_nothing_of_the_front_folds_over_that_is_seen_from_outside(name):
    model = head_model(name)
    middle, at = model.vertices[model.triangles].mean(axis=1), model.landmarks
    front = middle[:, 2] > at["ear_front_l"][2]
    lip, mouth, wet, ear = (model.material[model.triangles] > 0.02).any(axis=1).T
    below_tip, above_lip = middle[:, 1] < at["nose_tip"][1] + 0.01, middle[:, 1] > at["subnasale"][1] - 0.01
    nostrils = (np.abs(middle[:, 0]) < 1.3 * at["alare_l"][0]) & below_tip & above_lip
    folds = [ring.upper for side in "lr" for ring in model.eyelids.rings[side][LidRing.CREASE : LidRing.ORBIT + 2]]
    lid_fold = np.isin(model.triangles, np.concatenate(folds)).any(axis=1)
    flipped = front & (areas(model) <= 0.0)
    assert not (flipped & ~(lip | mouth | wet | ear | nostrils | lid_fold)).any()
    assert (flipped & lid_fold).sum() <= 12, "only the underside of the skin that hangs over the lids"
    ambient = model.shade[model.triangles, 0].mean(axis=1)
    assert np.percentile(ambient[flipped & lip], 95) < 0.05, "of the lips only what they press together"
    assert (flipped & nostrils & ~(lip | mouth)).sum() < 60


@pytest.mark.parametrize("name", FACES)
def test_the_face_gets_most_of_the_disc(name):
    model = head_model(name)
    middle, at = model.vertices[model.triangles].mean(axis=1), model.landmarks
    face = (middle[:, 2] > at["ear_front_l"][2]) & (middle[:, 1] > at["menton"][1])
    face &= middle[:, 1] < at["hairline_middle"][1]
    assert areas(model)[face].clip(0.0).sum() > 0.5 * np.pi / 4


@pytest.mark.parametrize("name", FACES)
def test_the_back_of_the_head_alone_has_no_picture(name):
    model = head_model(name)
    ahead = model.vertices[:, 2] > unwrap_centre(model.landmarks)[2]
    assert (model.uv_cover[ahead] == 1.0).all()
    assert (model.uv_cover == 0.0).sum() > 50
    cover = model.uv_cover[model.triangles]
    over_the_rim = model.uv[model.triangles[(cover > 0.0).any(axis=1) & (cover == 0.0).any(axis=1)]]
    sides = 0.5 * (over_the_rim + np.roll(over_the_rim, 1, axis=1))
    assert np.hypot(*(sides - 0.5).reshape(-1, 2).T).min() > 0.45, "none of them lies across the picture"


@given(st.lists(st.floats(-0.25, 0.25, width=32), min_size=3, max_size=3))
def test_any_point_is_in_the_disc_in_the_direction_that_it_is_seen(point):
    away = np.float32([point]) - CENTRE
    uv = unwrap(np.float32([point]), CENTRE)[0] - 0.5
    assert np.hypot(*uv) <= 0.5 + 1e-6
    assert abs(away[0, 0] * -uv[1] - away[0, 1] * uv[0]) < 1e-6
    assert uv[0] * away[0, 0] >= 0.0
    assert uv[1] * away[0, 1] <= 0.0
    assert 0.0 <= unwrap_cover(np.float32([point]), CENTRE)[0] <= 1.0


def test_straight_ahead_is_the_middle_and_equal_areas_stay_equal():
    ahead = np.float32(CENTRE + np.array([0.0, 0.0, 0.1]))
    np.testing.assert_allclose(unwrap(ahead[None], CENTRE), [[0.5, 0.5]], atol=1e-6)
    # zones of a sphere have areas in proportion to their heights (Archimedes)
    heights = np.linspace(1.0, -0.45, 30)
    ring = np.stack([np.sqrt(1.0 - heights**2), 0.0 * heights, heights], axis=1)
    radius = unwrap((CENTRE + 0.1 * ring).astype(np.float32), CENTRE)[:, 0] - 0.5
    np.testing.assert_allclose(np.diff(radius.astype(float) ** 2), (radius[-1] ** 2 - radius[0] ** 2) / 29, rtol=2e-4)


def test_coordinates_are_made_when_they_are_asked_for():
    assert not {"uv", "uv_cover"} & replace(load_model("amber")).__dict__.keys()


@pytest.mark.parametrize("kind", [np.float32, np.uint16])
def test_coordinates_of_the_file_are_read_exactly(face, kind):
    expected = some_coordinates()
    given = expected if kind == np.float32 else np.round(expected * np.iinfo(kind).max).astype(kind)
    document, accessor = textured(face, given)
    assert accessor.normalized == (kind != np.float32)
    model = load_model(face)
    exact = given if kind == np.float32 else (given.astype(np.float64) / np.iinfo(kind).max).astype(np.float32)
    np.testing.assert_array_equal(model.uv, exact)
    assert model.uv.dtype == np.float32
    assert (model.uv_cover == 1.0).all()
    assert document.asset.generator == "agentface"


@pytest.mark.parametrize("kind", [np.float32, np.uint8])
def test_rows_that_are_padded_or_interleaved_are_read(face, kind):
    expected = some_coordinates()
    if kind == np.uint8:
        expected = np.round(expected * 255)
    document, accessor = textured(face, np.concatenate([expected, expected[:, ::-1]], axis=1).astype(kind))
    accessor.type = "VEC2"
    document.bufferViews[accessor.bufferView].byteStride = 4 * np.dtype(kind).itemsize
    document.save_binary(str(face / "head.glb"))
    scale = np.float32(255 if kind == np.uint8 else 1)
    np.testing.assert_array_equal(load_model(face).uv, expected.astype(np.float32) / scale)


def test_a_finer_face_keeps_the_file_s_coordinates(face):
    textured(face, some_coordinates())
    model = load_model(face)
    finer = subdivided(model)
    np.testing.assert_allclose(finer.uv, model.uv[finer.parents].mean(axis=1), atol=1e-6)


def with_value(value):
    def change(coordinates):
        coordinates[7, 1] = value
        return coordinates

    return change


@pytest.mark.parametrize(
    ("change", "expected", "got"),
    [
        (lambda uv: uv[:-1], "an array of shape (6159, 2)", "(6158, 2)"),
        (lambda uv: np.repeat(uv, 2, axis=1), "an array of shape (6159, 2)", "(6159, 4)"),
        (lambda uv: np.ascontiguousarray(uv[:, 0]), "an array of shape (6159, 2)", "(6159,)"),
        (with_value(np.nan), "coordinates in 0..1", "nan"),
        (with_value(np.inf), "coordinates in 0..1", "inf"),
        (with_value(1.5), "coordinates in 0..1", "1.5] at vertex 7"),
        (with_value(-0.25), "coordinates in 0..1", "-0.25] at vertex 7"),
    ],
)
def test_wrong_coordinates_are_a_fault(face, change, expected, got):
    textured(face, change(some_coordinates()))
    with pytest.raises(DataError) as caught:
        load_model(face)
    (fault,) = caught.value.faults
    assert fault.where == "skin.TEXCOORD_0"
    assert fault.expected == expected
    assert got in fault.got
    checked = CliRunner().invoke(cli, ["check", str(face)])
    assert checked.exit_code == 1
    assert "head.glb: skin.TEXCOORD_0" in checked.output


@pytest.mark.parametrize("stride", [4, -8, 253, 248, 2**40])
def test_a_stride_beyond_the_file_is_a_fault(face, stride):
    document, accessor = textured(face, some_coordinates())
    document.bufferViews[accessor.bufferView].byteStride = stride
    document.save_binary(str(face / "head.glb"))
    with pytest.raises(DataError, match="GLB"):
        load_model(face)
