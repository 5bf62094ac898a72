"""Modes and weights of shapes, on movements made by hand: the errors that are told are those that are left."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.io.gltf.arkit_shapes import ShapeWeights
from agentface.io.gltf.modes import ModeFinder
from agentface.io.gltf.surface import apart_mm
from agentface.io.gltf.writer import quaternions

VERTICES = 60


def rows(frames: int, ways: int, seed: int, size: float = 0.004) -> np.ndarray:
    """``(frames, 3 V)`` m: sums of some ways, each less than the one before."""
    rng = np.random.default_rng(seed)
    basis = size * rng.normal(size=(ways, 3 * VERTICES)) * 0.5 ** np.arange(ways)[:, None]
    return rng.uniform(-1, 1, (frames, ways)) @ basis


def found(frames: np.ndarray, error_mm: float, most: int = 100):
    finder = ModeFinder(frames.shape[1])
    for row in frames:
        finder.add(row)
    return finder.modes(error_mm, most)


@pytest.mark.parametrize("error_mm", [0.02, 0.1, 1.0])
def test_modes_are_as_near_as_they_say(error_mm):
    frames = rows(40, 12, 3)
    modes = found(frames, error_mm)
    off = apart_mm(frames - modes.weights @ modes.ways)
    assert off.max() <= modes.error_max_mm + 1e-9 <= error_mm + 0.01
    assert np.sqrt((off**2).mean()) == pytest.approx(modes.error_rms_mm, abs=2e-3)
    assert np.abs(modes.weights).max() == pytest.approx(1.0)


def test_no_fewer_modes_would_do():
    frames = rows(40, 12, 4)
    modes = found(frames, 0.1)
    fewer = found(frames, 0.1, most=len(modes.ways) - 1)
    assert len(fewer.ways) == len(modes.ways) - 1
    assert fewer.error_max_mm > 0.1


def test_what_was_seen_before_is_no_new_mode():
    frames = np.tile(rows(5, 3, 5), (40, 1))
    assert len(found(frames, 0.02).ways) <= 3


def test_a_face_that_does_not_move_has_none():
    modes = found(np.zeros((4, 3 * VERTICES)), 0.1)
    assert modes.ways.shape == (0, 3 * VERTICES)
    assert modes.weights.shape == (4, 0)
    assert modes.error_max_mm == 0.0


def test_weights_of_shapes_are_those_that_a_movement_was_made_of():
    rng = np.random.default_rng(6)
    shapes, weights = 0.003 * rng.normal(size=(8, 3 * VERTICES)), rng.uniform(0, 1, (20, 8))
    fitting = ShapeWeights(shapes)
    for row in weights @ shapes:
        fitting.add(row)
    np.testing.assert_allclose(fitting.weights, weights, atol=2e-3)
    assert fitting.error_max_mm < 0.02


def test_weights_stay_within_their_range_and_the_error_is_what_is_left():
    rng = np.random.default_rng(7)
    shapes = 0.003 * rng.normal(size=(4, 3 * VERTICES))
    row = np.array([1.5, -0.5, 0.5, 0.0]) @ shapes
    fitting = ShapeWeights(shapes)
    fitting.add(row)
    (weights,) = fitting.weights
    assert weights.min() >= 0.0
    assert weights.max() <= 1.0
    assert fitting.error_max_mm == pytest.approx(apart_mm(row - weights @ shapes).max())


def test_no_quaternion_is_turned_over_on_the_way():
    angles = np.linspace(0.0, 4 * np.pi, 50)
    turns = np.array([[[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]] for a in angles])
    rows_ = quaternions(turns)
    assert (rows_[1:] * rows_[:-1]).sum(axis=1).min() > 0.9
    np.testing.assert_allclose(np.linalg.norm(rows_, axis=1), 1.0, atol=1e-6)
    np.testing.assert_allclose(np.abs(rows_[:, 1]), np.abs(np.sin(angles / 2)), atol=1e-6)
