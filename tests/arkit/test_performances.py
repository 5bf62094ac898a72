"""Live Link Face's tables as performances, and performances as such tables; the signs of their angles."""

from __future__ import annotations

import math

import numpy as np
import pytest

from agentface.arkit.performances import performance_of_weights, weights_of_performance
from agentface.arkit.stream import ANGLES, ArkitStream
from agentface.arkit.turns import angles_of, head_of
from agentface.deform.crowd import Crowd
from agentface.head.arkit import ARKIT_SHAPES
from agentface.motion.performance import Performance
from agentface.parameters import COUNT, NEUTRAL, indices_of
from tests.arkit.solvers import solver_of


def some_stream(count=12, gap_s=0.0, head=True):
    weights, angles = np.zeros((count, 52), np.float32), np.zeros((count, 9), np.float32)
    rise = np.sin(np.linspace(0.0, math.pi, count))
    for name, most in (("jawOpen", 0.5), ("mouthSmileLeft", 0.8), ("eyeLookUpLeft", 0.5), ("eyeLookUpRight", 0.5)):
        weights[:, ARKIT_SHAPES.index(name)] = most * rise
    if head:
        angles[:, 0] = 0.3 * rise
    times = np.arange(count) / 60.0
    times[count // 2 :] += gap_s
    return ArkitStream(times, weights, angles, 60.0, "take")


def test_a_stream_comes_back():
    solver, stream, told = solver_of("amber"), some_stream(), []
    performance = performance_of_weights(stream, solver, told.append)
    assert told == list(range(1, 13))
    assert (performance.rate_hz, performance.name) == (60.0, "take")
    assert {"jaw_open", "zygomaticus_major_l", "gaze_pitch", "head_yaw", "head_roll"} <= set(performance.moved)
    again = weights_of_performance(performance, solver)
    np.testing.assert_allclose(again.weights, stream.weights, atol=0.3)
    assert np.abs(again.weights - stream.weights).mean() < 0.007
    np.testing.assert_allclose(again.angles[:, :3], stream.angles[:, :3], atol=1e-6)
    np.testing.assert_array_equal(again.times_s, stream.times_s)


def test_without_angles_the_head_is_free():
    moved = performance_of_weights(some_stream(3, head=False), solver_of("amber")).moved
    assert not [name for name in moved if name.startswith("head")]


def test_a_long_gap_lets_go():
    performance = performance_of_weights(some_stream(6, gap_s=4.0), solver_of("amber"))
    assert len(performance) == 9
    assert performance.rate_hz is None
    _, weights = performance.sample(2.0)
    assert not weights.any()


def turned(**degrees):
    """How the nose of a face with these angles of Live Link Face points, and how far its left side rises."""
    angles = np.zeros((1, 9), np.float32)
    for name, angle in degrees.items():
        angles[0, ANGLES.index(name)] = math.radians(angle)
    pose = NEUTRAL.copy()
    pose[list(indices_of("head_yaw") + indices_of("head_pitch") + indices_of("head_roll"))] = head_of(angles)[0]
    turn = Crowd(solver_of("amber").model).deform(pose[None])[0].head[:3, :3]
    return turn @ np.array([0.0, 0.0, 1.0]), float((turn @ np.array([1.0, 0.0, 0.0]))[1])


def test_heads_turn_by_unreal_s_signs():
    """Epic's plug-in turns ARKit's quaternion (x, y, z, w) into (-z, x, y, -w); its rotator's angles are written."""
    for axis, name in ((1, "HeadYaw"), (0, "HeadPitch"), (2, "HeadRoll")):
        half = math.radians(20.0) / 2.0
        quaternion = np.zeros(4)
        quaternion[axis], quaternion[3] = math.sin(half), math.cos(half)
        x, y, z, w = -quaternion[2], quaternion[0], quaternion[1], -quaternion[3]
        written = {  # FQuat::Rotator
            "HeadYaw": math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z)),
            "HeadPitch": math.asin(2.0 * (z * x - w * y)),
            "HeadRoll": math.atan2(-2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y)),
        }
        nose, rise = turned(**{name: math.degrees(written[name])})
        # ARKit's axes are the face's: +x to the person's left, +y up, +z forward; turns are right-handed
        expected = {
            1: (math.sin(2 * half), 0.0, 0.0),
            0: (0.0, -math.sin(2 * half), 0.0),
            2: (0.0, 0.0, math.sin(2 * half)),
        }
        side, up, roll = expected[axis]
        assert (nose[0], nose[1], rise) == pytest.approx((side, up, roll), abs=1e-5)
        assert [round(angle, 6) for key, angle in written.items() if key != name] == [0.0, 0.0]


def test_angles_of_eyes_have_the_same_signs():
    solver = solver_of("amber")
    pose = NEUTRAL.copy()
    pose[indices_of("gaze_yaw")[0]], pose[indices_of("gaze_pitch")[0]] = 0.2, 0.1
    angles = angles_of(pose[None], np.array([solver.eyes.angles(pose)]))[0]
    found = dict(zip(ANGLES, angles.tolist(), strict=True))
    assert found["LeftEyeYaw"] == found["RightEyeYaw"] == pytest.approx(-0.2), "to the person's left"
    assert found["LeftEyePitch"] == pytest.approx(-0.1), "upward"
    assert found["LeftEyeRoll"] == found["HeadYaw"] == 0.0


def test_any_performance_has_weights():
    poses, weights = np.zeros((2, COUNT), np.float32), np.ones((1, COUNT), np.float32)
    poses[:, list(indices_of("zygomaticus_major"))] = 0.8
    poses[:, indices_of("jaw_open")[0]] = 0.3
    stream = weights_of_performance(Performance.regular(25.0, poses, weights), solver_of("amber"))
    shown = dict(zip(ARKIT_SHAPES, stream.weights[1].tolist(), strict=True))
    assert min(shown["mouthSmileLeft"], shown["mouthSmileRight"]) > 0.4
    assert 0.15 < shown["jawOpen"] < 0.45
    assert stream.rate_hz == 25.0
