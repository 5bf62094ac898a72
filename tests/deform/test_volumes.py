"""Volumes that muscles gather: where, how far, the same in both forms, and on both sides."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from agentface.deform.muscles import volumes
from agentface.deform.muscles import volumes_compiled as compiled
from agentface.head.volumes import VolumesFile
from agentface.parameters import COUNT, FacePose, indices_of
from tests.heads import head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
TABLES = {face: volumes.prepare(model) for face, model in FACES.items()}
LEVELS = hnp.arrays(np.float32, COUNT, elements=st.floats(0, 1, width=32))


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def moved(face, **muscles):
    points = FACES[face].vertices.copy()
    volumes.apply(TABLES[face], FacePose.of(**muscles).array, points)
    return points.astype(np.float64) - FACES[face].vertices


@settings(max_examples=30)
@given(LEVELS)
def test_both_forms_agree(values):
    for face, model in FACES.items():
        one, other = model.vertices.copy(), model.vertices.copy()
        volumes.apply(TABLES[face], values, one)
        compiled.apply(TABLES[face], values, other)
        np.testing.assert_allclose(one, other, atol=1e-7, rtol=0)


def test_a_face_at_rest_stays_to_the_bit(face):
    for module in (volumes, compiled):
        points = FACES[face].vertices.copy()
        module.apply(TABLES[face], FacePose().array, points)
        np.testing.assert_array_equal(points, FACES[face].vertices)


@settings(max_examples=20)
@given(LEVELS)
def test_mirrored_muscles_gather_mirrored_volumes(values):
    swapped = values.copy()
    for left, right in (indices_of(name) for name in ("zygomaticus_major", "risorius", "mentalis", "procerus")):
        swapped[[left, right]] = values[[right, left]]
    only = [i for name in ("zygomaticus_major", "risorius", "mentalis", "procerus") for i in indices_of(name)]
    others = np.setdiff1d(np.arange(COUNT), only)
    for face, model in FACES.items():
        one, other = model.vertices.copy(), model.vertices.copy()
        for pose, points in ((values, one), (swapped, other)):
            alone = pose.copy()
            alone[others] = 0.0
            volumes.apply(TABLES[face], alone, points)
        np.testing.assert_allclose(other[model.mirror] * [-1, 1, 1], one, atol=2e-6)


def test_a_smile_lifts_an_apple_out_of_each_cheek(face):
    way, model = moved(face, zygomaticus_major=1.0), FACES[face]
    out = (way * model.normals).sum(axis=1)
    top = model.vertices[out.argmax()]
    assert out.max() > 1e-3
    assert abs(top[0]) > abs(model.landmarks["alare_l"][0])
    assert model.landmarks["mouth_corner_l"][1] < top[1] < model.landmarks["pupil_l"][1]
    one_sided = moved(face, zygomaticus_major_l=1.0)
    assert np.linalg.norm(one_sided[model.vertices[:, 0] < -0.01], axis=1).max() < 1e-4


def test_the_chin_bulges_below_its_fold(face):
    way, at = moved(face, mentalis=1.0), FACES[face].landmarks
    out = (way * FACES[face].normals).sum(axis=1)
    near = {
        name: np.linalg.norm(FACES[face].vertices - at[name], axis=1).argmin() for name in ("pogonion", "chin_fold")
    }
    assert out[near["pogonion"]] > 2e-4
    assert out[near["chin_fold"]] < 0.5 * out[near["pogonion"]]


def test_lids_brows_and_scalp_are_left_alone_by_a_smile(face):
    model, way = FACES[face], np.linalg.norm(moved(face, zygomaticus_major=1.0, risorius=1.0), axis=1)
    for region in ("upper_face", "upper_eyelid"):
        assert way[model.regions.mask([region])].max() == 0.0
    assert way[model.vertices[:, 2] < 0.0].max() < 5e-4


def test_shares_add_up_to_one_and_no_further(face):
    alone = moved(face, zygomaticus_major=1.0, orbicularis_oculi_lateralis=1.0, orbicularis_oculi_medialis=1.0)
    apple = next(v for v in FACES[face].volumes if v.name == "cheek_apple_l")
    assert sum(apple.shares.values()) > 1.0
    own = np.zeros_like(alone)
    own[apple.vertices] = apple.ways
    others = replace(
        FACES[face],
        volumes_file=VolumesFile(
            volumes={name: row for name, row in FACES[face].volumes_file.volumes.items() if name != "cheek_apple"}
        ),
    )
    rest = FACES[face].vertices.copy()
    pose = FacePose.of(zygomaticus_major=1.0, orbicularis_oculi_lateralis=1.0, orbicularis_oculi_medialis=1.0)
    volumes.apply(volumes.prepare(others), pose.array, rest)
    left = FACES[face].vertices[:, 0] > 0.002
    np.testing.assert_allclose((alone - (rest - FACES[face].vertices))[left], own[left], atol=1e-7)


def test_a_face_without_volumes_has_empty_tables(face):
    tables = volumes.prepare(replace(FACES[face], volumes_file=VolumesFile(volumes={})))
    points = FACES[face].vertices.copy()
    for module in (volumes, compiled):
        module.apply(tables, FacePose.of(zygomaticus_major=1.0).array, points)
    np.testing.assert_array_equal(points, FACES[face].vertices)
