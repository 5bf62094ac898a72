"""Eyes that look at a point: seen through the deformer's own turns of eyes and head, they stay on it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface import Face
from agentface.deform.eyes import eyeballs
from agentface.deform.finish import head_turn
from agentface.motion.eyesight import Eyesight
from agentface.motion.figures import default_life
from agentface.parameters import HIGH, LOW, FacePose, parameter
from tests.heads import head_model
from tests.motion.living import channels, trace

FIGURES = default_life().look_at
HEAD = ("head_yaw", "head_pitch", "head_roll")
ANGLES = st.floats(-0.6, 0.6)
NEAR = st.tuples(st.floats(-0.15, 0.15), st.floats(-0.06, 0.1), st.floats(0.5, 2.0))


def misses_mm(pose: FacePose, point, face="amber") -> float:
    """By how much the further of the two lines of sight passes a point, with the eyes as the deformer turns them."""
    model, values = head_model(face), pose.array
    rotations, head = np.zeros((2, 3, 3), np.float32), np.zeros((4, 4), np.float32)
    eyeballs.apply(eyeballs.prepare(model), values, rotations)
    head_turn.apply(head_turn.prepare(model), values, head)
    found = []
    for side, rotation in zip("lr", rotations, strict=True):
        centre = head[:3, :3] @ model.eye_centre(side) + head[:3, 3]
        line = head[:3, :3] @ rotation @ np.array([0.0, 0.0, 1.0])
        arm = np.asarray(point) - centre
        found.append(float(np.linalg.norm(arm - (arm @ line) * line)))
    return 1000 * max(found)


@given(st.tuples(ANGLES, ANGLES, ANGLES), st.tuples(st.floats(-0.5, 0.5), st.floats(-0.5, 0.5), st.floats(0.3, 2)))
def test_a_point_in_the_head_s_axes_is_the_one_that_the_head_s_turn_takes_there(turn, point):
    sight, pose = Eyesight.of(head_model()), FacePose.of(**dict(zip(HEAD, turn, strict=True)))
    head = np.zeros((4, 4), np.float32)
    head_turn.apply(head_turn.prepare(head_model()), pose.array, head)
    there = head[:3, :3] @ np.array(sight.in_head(point, *turn)) + head[:3, 3]
    np.testing.assert_allclose(there, point, atol=1e-6)


@given(NEAR)
def test_eyes_in_a_head_straight_ahead_aim_as_the_deformer_says(point):
    assert Eyesight.of(head_model()).aim(point) == pytest.approx(eyeballs.toward(head_model(), point), abs=1e-9)


@pytest.mark.parametrize("face", ["amber", "onyx"])
def test_a_point_within_the_eyes_reach_is_looked_at_by_the_eyes_alone(face):
    shown = Face(head_model(face), compiled=False)
    shown.look_at((0.15, -0.02, 0.6), fade=0.0)
    assert misses_mm(shown.pose, (0.15, -0.02, 0.6), face) < 0.01
    assert all(shown.pose[name] == 0.0 for name in HEAD)


def look(point, fade=0.06, liveliness=0.0):
    mixer = channels(liveliness=liveliness)
    mixer.gaze.look_at(Eyesight.of(head_model()), point, fade)
    return mixer


def poses_of(mixer, seconds, hz=200):
    return [FacePose(row) for row in trace(mixer, seconds, hz)]


FAR = (0.5, 0.1, 0.45)
"""48 degrees aside: more than the eyes reach, less than eyes and head."""


def test_the_eyes_go_first_the_head_follows_and_the_eyes_come_back():
    poses = poses_of(look(FAR), 1.5)
    yaw, head = (np.degrees([pose[name] for pose in poses]) for name in ("gaze_yaw", "head_yaw"))
    arrived = round(0.06 * 200)
    assert yaw[arrived] > 40.0
    assert head[arrived] < 1.0
    assert (np.diff(head) >= -1e-4).all()
    assert 20.0 < head[-1] <= FIGURES.head_limit_deg[0]
    assert 5.0 < yaw[-1] < FIGURES.head_beyond * head_model().eyes.yaw_limit_deg
    reached = next(place for place, pose in enumerate(poses) if misses_mm(pose, FAR) < 0.05)
    assert reached < len(poses) - 60
    assert max(misses_mm(pose, FAR) for pose in poses[reached:]) < 0.05


def test_what_is_looked_at_is_held_whatever_turns_the_head():
    point, mixer = (0.1, 0.05, 0.7), look((0.1, 0.05, 0.7), 0.0)
    for turn in ((0.3, 0.0, 0.0), (-0.2, 0.15, 0.2), (0.0, 0.05, -0.3)):
        mixer.head.turn(turn, 0.4)
        mixer.gestures.play("nod")
        mixer.gestures.play("tilt")
        assert max(misses_mm(pose, point) for pose in poses_of(mixer, 0.6, 60)) < 0.05


def test_a_face_that_lives_holds_what_it_looks_at_until_it_glances_aside():
    point, mixer = (0.05, 0.0, 0.6), look((0.05, 0.0, 0.6), 0.0, liveliness=0.6)
    drift_mm = 2.5 * 650 * math.radians(default_life().saccades.drift_deg)
    poses = poses_of(mixer, default_life().saccades.stay_s, 60)
    assert np.ptp([pose["head_pitch"] for pose in poses]) > 1e-4
    assert max(misses_mm(pose, point) for pose in poses) < drift_mm


def test_eyes_that_look_ahead_hold_still_against_a_head_that_nods_and_sways():
    mixer = channels(liveliness=0.6)
    mixer.gestures.play("nod")
    mixer.gestures.play("shake")
    poses = trace(mixer, 1.4, 100)
    turned = {name: np.degrees(poses[:, parameter(name).index]) for name in ("head_pitch", "gaze_pitch")}
    assert np.ptp(turned["head_pitch"]) > 8.0
    still = channels(liveliness=0.6)
    glances = np.degrees(trace(still, 1.4, 100))
    world = turned["head_pitch"] + turned["gaze_pitch"]
    kept = glances[:, parameter("head_pitch").index] + glances[:, parameter("gaze_pitch").index]
    np.testing.assert_allclose(world, kept, atol=1e-3)


def test_a_head_that_is_told_to_turn_takes_eyes_along_that_look_along_angles():
    face = Face(head_model(), compiled=False)
    face.set_gaze(10, -5, fade=0)
    face.set_head(30, 0, fade=0)
    assert [math.degrees(face.pose[name]) for name in ("gaze_yaw", "gaze_pitch")] == pytest.approx([10, -5], abs=1e-4)


def test_a_gaze_by_angles_ends_the_look_and_the_head_comes_back():
    mixer = look(FAR)
    poses_of(mixer, 1.0)
    mixer.gaze.turn((0.1, 0.0, 0.0), 0.06)
    poses = poses_of(mixer, 1.5)
    assert poses[-1] == FacePose.of(gaze_yaw=0.1)
    assert mixer.gaze.point is None
    mixer = look(FAR)
    mixer.release(0.2)
    assert poses_of(mixer, 1.5)[-1] == FacePose()


def test_one_angle_set_by_hand_leaves_the_others_where_they_looked():
    mixer = look((0.1, 0.05, 0.7), 0.0)
    before = mixer.pose()
    mixer.gaze.turn_one("gaze_yaw", -0.2, 0.0)
    assert mixer.pose()["gaze_yaw"] == pytest.approx(-0.2)
    for name in ("gaze_pitch", "gaze_vergence"):
        assert mixer.pose()[name] == pytest.approx(before[name], abs=1e-6)


def test_the_targets_are_where_the_eyes_arrive():
    face = Face(head_model(), compiled=False)
    face.look_at(FAR)
    told = face.turned_deg
    for _ in range(100):
        face.channels.advance(0.02)
        face.channels.pose()
    shown = {name: math.degrees(face.channels.pose()[name]) for name in ("gaze_yaw", "gaze_pitch", "gaze_vergence")}
    assert {name: told[name] for name in shown} != shown
    assert {name: face.turned_deg[name] for name in shown} == pytest.approx(shown, abs=1e-3)


@pytest.mark.parametrize(("wide", "close_mm"), [(0.2, 3.0), (0.4, 5.0)])
def test_a_point_that_moves_is_followed_closely_by_eyes_and_head(wide, close_mm):
    mixer, misses = look((-wide, 0.0, 0.5), 0.0), []
    hole = math.radians(head_model().eyes.yaw_limit_deg)
    for frame in range(240):
        point = (wide * math.sin(math.pi * (frame / 120 - 0.5)), 0.0, 0.5)
        mixer.gaze.look_at(Eyesight.of(head_model()), point)
        mixer.advance(1 / 60)
        pose = mixer.pose()
        if abs(pose["gaze_yaw"]) + abs(pose["gaze_vergence"]) < hole:
            misses.append(misses_mm(pose, point))
    assert len(misses) > 180
    assert max(misses) < close_mm
    assert (abs(mixer.pose()["head_yaw"]) > math.radians(5.0)) == (wide > 0.3)


def test_the_same_point_again_changes_nothing():
    once, often = look(FAR), look(FAR)
    for _ in range(30):
        for mixer in (once, often):
            mixer.advance(0.02)
            mixer.pose()
        often.gaze.look_at(Eyesight.of(head_model()), FAR, 0.06)
    assert once.pose() == often.pose()


@pytest.mark.untraced
@given(st.tuples(st.floats(-5, 5), st.floats(-5, 5), st.floats(0.1, 3)), st.tuples(ANGLES, ANGLES, ANGLES))
def test_any_point_is_looked_at_as_far_as_eyes_and_head_turn(point, turn):
    mixer = look(point, 0.0)
    mixer.head.turn(turn, 0.0)
    for dt in (0.0, 0.05, 0.2, 1.0):
        mixer.advance(dt)
        pose = mixer.pose().array
        assert (pose >= LOW).all()
        assert (pose <= HIGH).all()
