"""Many faces at once are the same faces, bit for bit."""

from dataclasses import fields

import numpy as np
import pytest

from agentface.anatomy.model import load_model
from agentface.anatomy.resample import thinned
from agentface.bench.crowd import random_poses
from agentface.deform.crowd import Crowd
from agentface.deform.pipeline import GeometricDeformer
from agentface.errors import InvalidValueError
from agentface.parameters import COUNT, FacePose

MODELS = {face: load_model(face) for face in ("amber", "onyx")}
CROWD = Crowd(MODELS["amber"])


@pytest.fixture(scope="module")
def pair():
    crowd = Crowd(MODELS["amber"], threads=2)
    yield crowd
    crowd.close()


def assert_same(one, other):
    for field in fields(other):
        np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name), err_msg=field.name)


@pytest.mark.parametrize("face", MODELS)
def test_each_face_is_what_the_deformer_makes_of_its_pose(face):
    poses = random_poses(20)
    poses[3] = 0.0
    geometry = Crowd(MODELS[face]).deform(poses)
    deformer = GeometricDeformer(MODELS[face])
    assert len(geometry) == len(poses)
    for index, pose in enumerate(poses):
        assert_same(geometry.face(index), deformer.deform(FacePose(pose)))


def test_one_and_two_threads_make_the_same_faces(pair):
    for count in (1, 8, 9, 100):
        poses = random_poses(count, seed=count)
        assert_same(pair.deform(poses), CROWD.deform(poses))


def test_a_face_does_not_depend_on_its_neighbours_or_its_place(pair):
    poses = random_poses(40)
    before = pair.deform(poses).vertices.copy()
    order = np.random.default_rng(0).permutation(len(poses))
    np.testing.assert_array_equal(pair.deform(poses[order]).vertices, before[order])


def test_the_arrays_are_those_of_the_largest_crowd_and_overwritten():
    crowd = Crowd(MODELS["amber"])
    large = crowd.deform(random_poses(6))
    kept = large.vertices.copy()
    small = crowd.deform(np.zeros((2, COUNT)))
    assert len(small) == 2
    assert np.shares_memory(small.vertices, large.vertices)
    np.testing.assert_array_equal(large.vertices[0], MODELS["amber"].vertices)
    np.testing.assert_array_equal(large.vertices[2:], kept[2:])


def test_a_crowd_of_nobody_has_no_faces(pair):
    assert len(pair.deform(np.zeros((0, COUNT)))) == 0


def test_a_coarser_face_makes_a_crowd_too():
    model = thinned(MODELS["amber"], 4000)
    poses = random_poses(2)
    geometry, deformer = Crowd(model).deform(poses), GeometricDeformer(model)
    for index, pose in enumerate(poses):
        assert_same(geometry.face(index), deformer.deform(FacePose(pose)))


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        (np.zeros(COUNT), r"shape \(B, \d+\)"),
        (np.zeros((2, COUNT - 1)), r"shape \(B, \d+\)"),
        (np.full((1, COUNT), np.nan), r"pose 0: .*frontalis"),
        (np.full((3, COUNT), 1.5), "number in 0..1"),
    ],
)
def test_bad_poses_are_refused_by_name(poses, message):
    with pytest.raises(InvalidValueError, match=message):
        CROWD.deform(poses)


def test_a_value_that_is_not_finite_is_told_with_its_face():
    poses = np.zeros((5, COUNT), np.float32)
    poses[4, -1] = np.inf
    with pytest.raises(InvalidValueError, match=r"pose 4: .*finite"):
        CROWD.deform(poses)


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "2"])
def test_threads_are_counted_from_one(threads):
    with pytest.raises(InvalidValueError, match="threads"):
        Crowd(MODELS["amber"], threads)
