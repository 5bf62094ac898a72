from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.studies.calibration.tissue_loss import ShapeLoss

SIDE = 6
SEEDS = st.integers(0, 2**32 - 1)


def patch():
    """A square patch of tissue, whose last row stays and whose first corner is not in the lattice."""
    grid = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    edges = np.concatenate([np.stack([grid[:, :-1], grid[:, 1:]], -1), np.stack([grid.T[:, :-1], grid.T[:, 1:]], -1)])
    x, y = np.meshgrid(3.0 * np.arange(SIDE), 3.0 * np.arange(SIDE))
    rest = np.stack([x, y, np.zeros_like(x)], -1).reshape(-1, 3)
    absent = np.zeros(SIDE * SIDE, bool)
    absent[0] = True
    free = ~absent
    free[grid[-1]] = False
    lattice = SimpleNamespace(
        free=free, edges=edges.reshape(-1, 2), members=SimpleNamespace(absent=absent), rest=np.stack([rest] * 3)
    )
    target = np.exp(-((rest - rest[14]) ** 2).sum(1, keepdims=True) / 40.0) * [4.0, 2.0, 1.0]
    return lattice, target


@pytest.fixture(scope="module")
def loss():
    return ShapeLoss(*patch())


def moves(seed):
    return np.random.default_rng(seed).normal(0, 1.5, (SIDE * SIDE, 3))


@pytest.mark.parametrize("part", ["shape", "stretch"])
@given(seed=SEEDS)
def test_the_gradients_are_those_of_finite_differences(loss, part, seed):
    moved, way = moves(seed), moves(seed + 1)
    measure = getattr(loss, part)
    step = 1e-5
    expected = (measure(moved + step * way)[0] - measure(moved - step * way)[0]) / (2 * step)
    assert (measure(moved)[1] * way).sum() == pytest.approx(expected, rel=1e-5, abs=1e-7)


def test_the_target_itself_costs_next_to_nothing(loss):
    _, target = patch()
    assert loss.stretch(target)[0] == 0.0
    value, _ = loss.shape(target)
    assert 0.0 < value < 0.02, "only that small movements have no clear direction"
    for off in (0.0 * target, 0.5 * target, 1.5 * target, -target):
        assert loss.shape(off)[0] > 3 * value


def test_what_cannot_move_does_not_count(loss):
    lattice, target = patch()
    off = np.where(lattice.free[:, None], target, target + 5.0)
    assert loss.shape(off)[0] == loss.shape(target)[0]


def test_a_pinch_costs_stretch_and_a_shift_of_everything_none(loss):
    _, target = patch()
    pinched = target.copy()
    pinched[14] += [2.0, 0.0, 0.0]
    assert loss.stretch(target + 3.0)[0] == pytest.approx(0.0, abs=1e-20)
    assert loss.stretch(pinched)[0] > 0.01


def test_the_peak_is_that_of_what_can_move():
    lattice, target = patch()
    target[0] = 100.0
    assert ShapeLoss(lattice, target).peak == pytest.approx(np.linalg.norm(patch()[1], axis=1).max())
