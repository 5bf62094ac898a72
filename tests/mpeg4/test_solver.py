"""Bounded least squares: the minimum in a box against scipy, and features of any kind brought back."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from agentface.head.model import load_model
from agentface.mpeg4 import sight_compiled, solver_compiled
from agentface.mpeg4.jacobian import mean_jacobian
from agentface.mpeg4.readings import Kind, Readings
from agentface.mpeg4.sight import Features
from agentface.mpeg4.solver import SHARE, Problem, Wish, box_minimum, learn
from agentface.parameters import COUNT, HIGH, LOW, NEUTRAL, VECTOR_MUSCLES, indices_of
from tests.mpeg4.solvers import solver_of, some_poses


def problem(seed, count):
    draw = np.random.default_rng(seed)
    rows = draw.normal(size=(count + 5, count)) * 10.0 ** draw.uniform(-1, 0.3, count)
    low = -draw.random(count) * (draw.random(count) < 0.7)
    return rows, draw.normal(size=count + 5), low, draw.random(count)


@given(st.integers(0, 10**6), st.integers(1, 30))
def test_the_minimum_in_a_box_is_scipy_s(seed, count):
    rows, right, low, high = problem(seed, count)
    expected = lsq_linear(rows, right, (low - 1e-12, high), method="bvls", tol=1e-14).x
    for minimum in (box_minimum, solver_compiled.box_minimum):
        a, b, x = rows.T @ rows, rows.T @ right, np.clip(np.zeros(count), low, high)
        before = 0.0
        for _ in range(20):
            minimum(a, b, low, high, x)
            assert 0.5 * x @ a @ x - b @ x <= before + 1e-12, "it descends"
            before = 0.5 * x @ a @ x - b @ x
        assert (x >= low).all()
        assert (x <= high).all()
        assert before == pytest.approx(0.5 * expected @ a @ expected - b @ expected, abs=1e-5)


def test_the_compiled_minimum_is_numpy_s():
    rows, right, low, high = problem(3, 40)
    found = []
    for minimum in (box_minimum, solver_compiled.box_minimum):
        x = np.zeros(40)
        minimum(rows.T @ rows, rows.T @ right, low, high, x)
        found.append(x)
    np.testing.assert_allclose(*found, atol=1e-9)


@given(st.integers(0, 10**6))
def test_a_learned_step_is_foretold_and_the_pattern_kept(seed):
    draw = np.random.default_rng(seed)
    pattern = (draw.random((6, 9)) < 0.5).astype(np.float64)
    pattern[:, 0] = 1.0
    before = draw.normal(size=(6, 9)) * pattern
    step, change = draw.normal(size=9) + np.eye(9)[0], draw.normal(size=6)
    after = before.copy()
    learn(after, pattern, step, change)
    felt = pattern @ step**2 > SHARE * (step @ step)
    np.testing.assert_allclose((after @ step)[felt], change[felt], atol=1e-9)
    assert not after[pattern == 0.0].any()
    # of all that foretell it inside the pattern, it is the nearest: what it adds has rank one a row
    added = after - before
    np.testing.assert_allclose(added, pattern * step * (added[:, :1] / step[0]), atol=1e-9)
    compiled = before.copy()
    solver_compiled.learn(compiled, pattern, step, change)
    np.testing.assert_allclose(compiled, after, atol=1e-12)


def test_any_linear_features_are_solved_for():
    model, draw = load_model("amber"), np.random.default_rng(1)
    vertex = draw.choice(np.flatnonzero(model.vertices[:, 2] > 0.05), 60, replace=False)
    vertices, axes = np.repeat(vertex, 3), np.tile(np.arange(3), 60)
    rest = model.vertices[vertices, axes].astype(np.float64)
    kind = np.full(180, Kind.SKIN, np.int32)
    scale = np.full(180, 1e3)
    bone, roll = np.zeros((1, 3)), np.zeros(3, np.int32)
    readings = Readings(kind, vertices.astype(np.int32), axes.astype(np.int32), scale, rest, bone, roll)
    sight = sight_compiled.new_sight(model, Features(readings, draw.normal(size=(80, 180)) / 10))

    def look(poses):
        out = np.empty((len(poses), 80))
        for pose, row in zip(np.ascontiguousarray(poses, np.float32), out, strict=True):
            sight_compiled.look(sight, pose, row)
        return out

    free = np.array([indices_of(name)[0] for name in VECTOR_MUSCLES], np.int32)
    poses = np.zeros((4, COUNT), np.float32)
    poses[:, free] = 0.5 * draw.random((4, len(free))) * (draw.random((4, len(free))) < 0.4)
    jacobian = mean_jacobian(look, poses[1:], free)[:, free]
    low, high = LOW[free].astype(np.float64), HIGH[free].astype(np.float64)
    fit = Problem(free, low, high, jacobian, np.ones_like(jacobian))
    goal, values, features = look(poses[:1])[0], NEUTRAL.copy(), np.zeros(80)
    nothing = 1e-4 * np.eye(len(free))
    wish = Wish(goal, np.ones(80), np.zeros(len(free), np.bool_), nothing, 0.0, 6)
    looks = solver_compiled.solve(sight, fit, wish, values, features)
    assert 1 <= looks <= 6
    np.testing.assert_allclose(features, look(values[None])[0], atol=1e-9)
    assert np.linalg.norm(features - goal) < 0.03 * np.linalg.norm(goal)
    others = np.setdiff1d(np.arange(COUNT), free)
    assert not values[others].any()


@pytest.mark.parametrize(("kind", "most"), [("uniform", 0.03), ("natural", 0.002)])
def test_a_look_sees_what_the_whole_face_shows(kind, most):
    solver = solver_of("amber")
    poses = some_poses(kind, 40, 9)
    from tests.mpeg4.solvers import measured

    whole = measured("amber", poses)
    seen = np.stack([solver.measured(values) for values in poses])
    usable = np.zeros(68, np.bool_)
    usable[solver.meter.columns] = solver.fit.usable
    error = np.abs(seen - whole)[:, usable] / solver.fit.ranges[solver.fit.usable]
    assert error.max() < most, "all that it leaves out are creases where lids and lips press the skin"
    assert np.quantile(error, 0.98) < 1e-4
