"""FAPs to poses: the round trip, masks, lids, what is out of reach, streams."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from agentface.errors import InvalidValueError
from agentface.mpeg4.fap_solver import FapSolver
from agentface.mpeg4.faps import fap
from agentface.parameters import COUNT, HIGH, LOW, NAMES, PARAMETERS, FacePose
from agentface.resources import face_names
from tests.heads import deformer_of, head_model
from tests.mpeg4.solvers import measured, ranges_of, solver_of, some_poses

FACES = face_names()
ALL = np.ones(68, np.bool_)


def only(**values):
    faps, mask = np.zeros(68), np.zeros(68, np.bool_)
    for name, value in values.items():
        faps[fap(name).number - 1], mask[fap(name).number - 1] = value, True
    return faps, mask


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize(("kind", "most", "worst"), [("uniform", 1.5, 5.0), ("natural", 0.5, 1.5)])
def test_a_round_trip_brings_every_fap_back(face, kind, most, worst):
    solver = solver_of(face)
    targets = measured(face, some_poses(kind, 500, 0)).copy()
    found = np.stack([solver.solve(target).pose.array for target in targets])
    ranges = ranges_of(face)
    moving = ranges > 10.0
    assert moving.sum() >= 55
    error = 100 * np.abs(measured(face, found) - targets)[:, moving] / ranges[moving]
    assert error.mean() <= most
    assert error.mean(axis=0).max() <= worst


@pytest.mark.parametrize("face", FACES)
def test_what_is_told_is_what_the_face_shows(face):
    solver = solver_of(face)
    target = measured(face, some_poses("natural", 1, 4))[0].astype(float)
    found = solver.solve(target)
    shown = measured(face, found.pose.array[None])[0]
    usable = ranges_of(face) > 10.0
    np.testing.assert_allclose(found.shown[usable], shown[usable], atol=0.6)
    np.testing.assert_allclose(found.missed[2:], (found.shown - target)[2:], atol=1e-3)
    assert found.out_of_reach == ()
    assert 1 <= found.looks <= solver.steps


def test_nothing_asked_is_a_face_at_rest():
    found = solver_of("amber").solve(np.zeros(68))
    np.testing.assert_allclose(found.pose.array, 0.0, atol=1e-6)
    assert found.out_of_reach == ()
    named = np.arange(68) % 3 == 0
    np.testing.assert_allclose(solver_of("amber").solve(np.zeros(68), named).pose.array, 0.0, atol=1e-6)


GROUPS = {
    "brows": ([31, 32, 33, 34, 35, 36, 37, 38], 60.0, ("brow",)),
    "lids": ([19, 20, 21, 22], 300.0, ("eyes",)),
    "jaw": ([3], 600.0, ("jaw",)),
    "corners": ([12, 13], -250.0, ("mouth", "nose and cheek")),
    "head": ([48, 49, 50], 2e4, ("head",)),
    "gaze": ([23, 24, 25, 26], 1e4, ("gaze",)),
}


@pytest.mark.parametrize("name", GROUPS)
def test_a_masked_stream_moves_nothing_that_it_does_not_name(name):
    numbers, value, groups = GROUPS[name]
    faps, mask = np.full(68, np.nan), np.zeros(68, np.bool_)
    for number in numbers:
        faps[number - 1], mask[number - 1] = value, True
    before = FacePose.of(zygomaticus_major=0.5, risorius=0.2, head_yaw=0.1)
    found = solver_of("amber").solve(faps, mask, before)
    changed = np.flatnonzero(found.pose.array != before.array)
    assert len(changed)
    assert set(changed) <= set(np.flatnonzero(found.moves))
    assert {PARAMETERS[index].group for index in changed} <= set(groups)
    assert not found.missed[~mask].any()


@pytest.mark.parametrize("face", FACES)
@pytest.mark.parametrize(
    "asked",
    [
        {"close_t_l_eyelid": 1024, "close_b_l_eyelid": 0},
        {"close_t_l_eyelid": 1024},
        {"close_t_l_eyelid": 600, "close_b_l_eyelid": 424},
        {"close_t_l_eyelid": 1024, "close_t_r_eyelid": 1024, "close_b_l_eyelid": 0, "close_b_r_eyelid": 0},
        {"close_t_l_eyelid": 1080, "close_t_r_eyelid": 1080},
    ],
    ids=["one", "one, upper named", "one, shared", "both", "both, upper named"],
)
def test_lids_that_are_told_to_close_close(face, asked):
    found = solver_of(face).solve(*only(**asked))
    shown = measured(face, found.pose.array[None])[0]
    assert shown[18] + shown[20] > 0.97 * 1024
    if "close_t_r_eyelid" in asked:
        assert shown[19] + shown[21] > 0.97 * 1024
    else:
        assert shown[19] + shown[21] < 0.35 * 1024, "the other eye stays open"
    assert {PARAMETERS[index].group for index in np.flatnonzero(found.pose.array)} <= {"eyes"}


def test_a_mouth_that_is_told_alone_is_shown():
    face = "amber"
    target = measured(face, some_poses("natural", 8, 6)).astype(float)
    mouth = np.zeros(68, np.bool_)
    mouth[[number - 1 for number in (*range(3, 19), *range(51, 61))]] = True
    for row in target:
        found = solver_of(face).solve(row, mouth)
        error = np.abs(measured(face, found.pose.array[None])[0] - row)[mouth] / ranges_of(face)[mouth]
        assert error.mean() < 0.01
        assert not found.pose.array[[NAMES.index("head_yaw"), NAMES.index("gaze_yaw")]].any()


@pytest.mark.parametrize("face", FACES)
def test_a_tongue_that_is_told_to_come_out_of_an_open_mouth_comes_out(face):
    found = solver_of(face).solve(*only(open_jaw=700.0, thrust_tongue_tip=700.0))
    assert found.shown[fap("thrust_tongue_tip").number - 1] == pytest.approx(700.0, rel=0.15)
    assert found.pose["tongue_out"] > 0.4
    assert not solver_of(face).solve(*only(thrust_tongue_tip=700.0)).pose["jaw_open"], "the jaw is not named"


def test_what_is_out_of_reach_is_told_and_clamped():
    solver = solver_of("amber")
    found = solver.solve(*only(raise_l_i_eyebrow=1800, raise_r_i_eyebrow=1800))
    assert found.out_of_reach == (31, 32)
    assert (found.missed[[30, 31]] < -1000).all()
    assert (found.shown[[30, 31]] > 60).all()
    assert {PARAMETERS[index].group for index in np.flatnonzero(found.pose.array)} <= {"brow"}
    assert (found.pose.array >= LOW).all()
    assert (found.pose.array <= HIGH).all()


def test_a_growing_wish_is_followed_without_a_jump():
    solver, shown = solver_of("amber"), []
    found = None
    for value in np.linspace(0.0, 400.0, 41):
        found = solver.solve(*only(raise_l_i_eyebrow=value, raise_r_i_eyebrow=value), found)
        shown.append(found.shown[30])
    steps = np.diff(shown)
    assert steps.max() < 12.0
    assert steps.min() > -2.0
    assert shown[5] == pytest.approx(50.0, abs=8.0)


def test_a_stream_is_followed_frame_by_frame():
    face = "amber"
    ends = some_poses("natural", 4, 12)
    way = np.linspace(0, 1, 12, endpoint=False)[:, None]
    walk = np.concatenate([a + way * (b - a) for a, b in pairwise(ends)])
    targets = measured(face, walk.astype(np.float32)).astype(float)
    solver, found, poses = solver_of(face), None, []
    for target in targets:
        found = solver.solve(target, previous=found)
        poses.append(found.pose.array)
    moving = ranges_of(face) > 10.0
    error = 100 * np.abs(measured(face, np.stack(poses)) - targets)[:, moving] / ranges_of(face)[moving]
    assert error.mean() < 0.5
    assert error.mean(axis=0).max() < 1.5
    # no more restless than what it follows, by more than a few times
    jerk, truth = (np.abs(np.diff(each, 2, axis=0)).mean() for each in (np.stack(poses), walk))
    assert jerk < 4.0 * truth


@pytest.mark.slow
def test_numpy_finds_the_same_pose():
    solver, plain = solver_of("onyx"), FapSolver(solver_of("onyx").model, compiled=False)
    target = measured("onyx", some_poses("natural", 1, 8))[0]
    one, other = solver.solve(target), plain.solve(target)
    np.testing.assert_allclose(one.pose.array, other.pose.array, atol=0.02)
    np.testing.assert_allclose(one.shown, other.shown, atol=3.0)


def test_what_is_no_frame_is_refused():
    solver = solver_of("amber")
    for faps in (np.zeros(67), np.zeros((2, 68))):
        with pytest.raises(InvalidValueError, match="faps"):
            solver.solve(faps)
    with pytest.raises(InvalidValueError, match="mask"):
        solver.solve(np.zeros(68), np.ones(66, np.bool_))
    faps = np.zeros(68)
    faps[18] = np.nan
    with pytest.raises(InvalidValueError, match="FAP 19"):
        solver.solve(faps)
    assert solver.solve(faps, np.arange(68) != 18).pose == FacePose()
    with pytest.raises(InvalidValueError, match="steps"):
        FapSolver(head_model(), steps=0)


def test_what_is_found_is_in_range_whatever_is_asked():
    solver, draw = solver_of("amber"), np.random.default_rng(2)
    for scale in (1e2, 1e4, 1e8):
        found = solver.solve(scale * draw.normal(size=68))
        assert np.isfinite(found.pose.array).all()
        assert found.pose.array.shape == (COUNT,)
        assert np.isfinite(deformer_of().at(found.pose).vertices).all()
