"""Many faces at once are the same faces, bit for bit."""

import math
from dataclasses import fields
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform.crowd import Crowd
from agentface.deform.pipeline import GeometricDeformer
from agentface.errors import InvalidValueError
from agentface.head.resample import thinned
from agentface.parameters import COUNT, NAMES, PARAMETERS, FacePose, check_pose, check_poses
from agentface.studies.bench.crowd import random_poses
from tests.heads import deformer_of, head_model

MODELS = {face: head_model(face) for face in ("amber", "onyx")}


@cache
def crowd():
    return Crowd(MODELS["amber"])


@pytest.fixture(scope="module")
def pair():
    pair = Crowd(MODELS["amber"], threads=2)
    yield pair
    pair.close()


def assert_same(one, other):
    for field in fields(other):
        np.testing.assert_array_equal(getattr(one, field.name), getattr(other, field.name), err_msg=field.name)


@pytest.mark.slow
@pytest.mark.parametrize("face", MODELS)
def test_each_face_is_what_the_deformer_makes_of_its_pose(face):
    poses = random_poses(20)
    poses[3] = 0.0
    geometry = Crowd(MODELS[face]).deform(poses)
    deformer = deformer_of(face)
    assert len(geometry) == len(poses)
    for index, pose in enumerate(poses):
        assert_same(geometry[index], deformer.at(FacePose(pose)))


def test_one_and_two_threads_make_the_same_faces(pair):
    for count in (1, 8, 9, 100):
        poses = random_poses(count, seed=count)
        assert_same(pair.deform(poses), crowd().deform(poses))


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


@pytest.mark.slow
def test_a_coarser_face_makes_a_crowd_too():
    model = thinned(MODELS["amber"], 4000)
    poses = random_poses(2)
    geometry, deformer = Crowd(model).deform(poses), GeometricDeformer(model)
    for index, pose in enumerate(poses):
        assert_same(geometry[index], deformer.at(FacePose(pose)))


@pytest.mark.parametrize(
    ("poses", "message"),
    [
        (np.zeros(COUNT), r"shape \(B, \d+\)"),
        (np.zeros((2, COUNT - 1)), r"shape \(B, \d+\)"),
        (np.full((1, COUNT), np.nan), r"pose 0: .*frontalis"),
        (np.full((3, COUNT), 1.5), r"number in 0\.\.1, got 1\.5"),
        (np.full((1, COUNT), 1e300), r"pose 0: .*finite number, got inf"),
        ("pose", "array of numbers"),
        (["a"] * COUNT, "array of numbers"),
        ([["a"] * COUNT], "array of numbers"),
        ([[0.0] * COUNT, [0.0]], "array of numbers"),
        (np.zeros((1, COUNT), np.complex64), "array of numbers.*complex64"),
        (np.zeros((1, COUNT), np.bool_), "array of numbers.*bool"),
        (FacePose(), "array of numbers"),
        (None, "array of numbers"),
    ],
)
def test_bad_poses_are_refused_by_name(poses, message):
    with pytest.raises(InvalidValueError, match=message):
        crowd().deform(poses)


def test_a_value_that_is_not_finite_is_told_with_its_face():
    poses = np.zeros((5, COUNT), np.float32)
    poses[4, -1] = np.inf
    with pytest.raises(InvalidValueError, match=r"pose 4: .*finite"):
        crowd().deform(poses)


@pytest.mark.parametrize("known", PARAMETERS, ids=NAMES)
def test_every_parameter_has_its_range_and_the_whole_of_it(known):
    rows = np.zeros((2, COUNT), np.float32)
    what = "angle" if known.unit == "rad" else known.unit
    for limit, way in ((known.low, -math.inf), (known.high, math.inf)):
        rows[1, known.index] = limit
        crowd().deform(rows)
        deformer_of("amber").at(FacePose.of(**{known.name: limit}))
        rows[1, known.index] = np.nextafter(np.float32(limit), np.float32(way))
        with pytest.raises(InvalidValueError, match=rf"^pose 1: {what} of {known.name}: expected a number in .*\.\."):
            crowd().deform(rows)
        with pytest.raises(InvalidValueError, match=rf"^{what} of {known.name}: expected a number in .*\.\."):
            deformer_of("amber").at(FacePose(rows[1]))


@settings(max_examples=200)
@given(st.lists(st.floats(0, 1), min_size=COUNT, max_size=COUNT))
def test_what_a_pose_takes_the_deformers_take(fractions):
    limits = zip(PARAMETERS, fractions, strict=True)
    within = {known.name: min(known.low + (known.high - known.low) * part, known.high) for known, part in limits}
    pose = FacePose.of(**within)
    check_pose(pose.array)
    check_poses(pose.array[None])


def test_a_sequence_of_poses_is_a_crowd():
    poses = [FacePose.of(jaw_open=0.5), FacePose.of(zygomaticus_major=1.0, head_yaw=-0.3)]
    kept = crowd().deform(np.stack([pose.array for pose in poses])).vertices.copy()
    for sequence in (poses, tuple(poses), [poses[0], poses[1].array.tolist()]):
        np.testing.assert_array_equal(crowd().deform(sequence).vertices, kept)
    assert len(crowd().deform([])) == 0


@pytest.mark.parametrize("threads", [1, 2])
def test_a_closed_crowd_says_so(threads):
    crowd = Crowd(MODELS["amber"], threads)
    crowd.deform(random_poses(20))
    crowd.close()
    crowd.close()
    with pytest.raises(InvalidValueError, match="not closed"):
        crowd.deform(random_poses(20))


@pytest.mark.parametrize("threads", [0, -1, 1.5, True, "2"])
def test_threads_are_counted_from_one(threads):
    with pytest.raises(InvalidValueError, match="threads"):
        Crowd(MODELS["amber"], threads)


def test_poses_that_may_be_written_compile_nothing_anew():
    from agentface.deform.order_compiled import frames

    model = head_model()
    deformer_of().at(FacePose())
    known = list(frames.signatures)
    for dtype in (np.float32, np.float64):
        with Crowd(model) as crowd:
            crowd.deform(np.zeros((2, COUNT), dtype))
    assert frames.signatures == known
