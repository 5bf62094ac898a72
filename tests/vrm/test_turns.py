"""Quaternions and angles against scipy's, and against the turns that the face itself makes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from agentface.deform.eyes import eyeballs
from agentface.deform.finish import head_turn
from agentface.parameters import NEUTRAL, indices_of
from agentface.vrm.turns import (
    STILL,
    eye_angles,
    head_angles,
    inverse,
    part_of,
    product,
    quaternion_of,
    rotation_of,
    unit,
)  # fmt: skip
from tests.heads import head_model

PARTS = st.floats(-1, 1)
QUATERNIONS = st.tuples(PARTS, PARTS, PARTS, PARTS).map(unit).filter(lambda turn: turn is not None)


def same(one, other):
    """Whether two quaternions are one turn."""
    return abs(abs(float(np.dot(one, other))) - 1.0) < 1e-9


@given(QUATERNIONS, QUATERNIONS)
def test_they_are_scipy_s(one, other):
    first, second = Rotation.from_quat(one), Rotation.from_quat(other)
    np.testing.assert_allclose(rotation_of(one), first.as_matrix(), atol=1e-12)
    assert same(quaternion_of(first.as_matrix()), one)
    assert quaternion_of(first.as_matrix())[3] >= 0.0
    assert same(product(one, other), (first * second).as_quat())
    assert same(product(one, inverse(one)), STILL)


@given(QUATERNIONS, st.floats(0, 1))
def test_a_part_of_a_turn_is_about_the_same_axis(turn, share):
    turn = quaternion_of(rotation_of(turn))
    part = part_of(turn, share)
    expected = Rotation.from_rotvec(share * Rotation.from_quat(turn).as_rotvec())
    assert (Rotation.from_quat(part) * expected.inv()).magnitude() < 1e-6
    rest = product(inverse(part), turn)
    assert same(product(part, rest), turn)


@pytest.mark.parametrize("turn", [(0.0, 0.0, 0.0, 0.0), (math.nan, 0.0, 0.0, 1.0), (math.inf, 0.0, 0.0, 1.0)])
def test_no_direction_is_no_turn(turn):
    assert unit(turn) is None


@given(st.floats(-80, 80), st.floats(-60, 60), st.floats(-50, 50))
def test_angles_of_a_head_are_those_that_turned_it(yaw, pitch, roll):
    values, turn = NEUTRAL.copy(), np.zeros((4, 4), np.float32)
    angles = np.radians([yaw, pitch, roll])
    for name, angle in zip(("head_yaw", "head_pitch", "head_roll"), angles, strict=True):
        values[indices_of(name)[0]] = angle
    head_turn.apply(head_turn.prepare(head_model()), values, turn)
    np.testing.assert_allclose(head_angles(quaternion_of(turn[:3, :3])), angles, atol=1e-5)


@given(st.floats(-30, 30), st.floats(-20, 20), st.floats(-5, 10))
def test_angles_of_eyes_are_those_that_turned_them(yaw, pitch, inward):
    tables = eyeballs.prepare(head_model())
    values, turns = NEUTRAL.copy(), np.zeros((2, 3, 3), np.float32)
    for name, angle in (("gaze_yaw", yaw), ("gaze_pitch", pitch), ("gaze_vergence", inward)):
        values[indices_of(name)[0]] = math.radians(angle)
    eyeballs.apply(tables, values, turns)
    for side, turn in enumerate(turns):
        found = eye_angles(quaternion_of(turn))
        np.testing.assert_allclose(found, eyeballs.eye_angles(tables, values, side), atol=1e-5)
