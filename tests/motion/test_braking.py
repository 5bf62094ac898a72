from __future__ import annotations

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from agentface.emotion.ramps import KNOTS, exponential_offset, exponential_onset
from agentface.motion.braking import braking, steepest_start

EVEN, FINE = np.linspace(0.0, 1.0, KNOTS), np.linspace(0.0, 1.0, 2001)


def test_a_speed_is_braked_away_without_a_rest():
    value, speed = braking(FINE)
    assert (value[0], speed[0], value[-1], speed[-1]) == (0.0, 1.0, 0.0, 0.0)
    np.testing.assert_allclose(np.gradient(value, FINE, edge_order=2), speed, atol=1e-5)
    assert 0.19 < value.max() < 0.2


@pytest.mark.parametrize("ramp", [exponential_onset(), exponential_offset()])
def test_a_move_with_the_steepest_start_does_not_turn_back(ramp):
    curve, steepest = CubicHermiteSpline(EVEN, *ramp.T), steepest_start(ramp[:, 1])
    assert np.diff(curve(FINE) + 0.98 * steepest * braking(FINE)[0]).min() >= -1e-9
    assert np.diff(curve(FINE) + 1.1 * steepest * braking(FINE)[0]).min() < 0.0


def test_the_steepest_start_of_the_minimum_jerk_path():
    assert steepest_start(30.0 * FINE**2 * (1.0 - FINE) ** 2) == pytest.approx(2.5, abs=1e-3)
