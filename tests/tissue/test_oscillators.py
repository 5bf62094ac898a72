"""The muscles' swing, held against an integration of its equation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from agentface.conventions import Doubles
from agentface.tissue.oscillators import Oscillators

SWING = Oscillators(np.array([20.0, 35.0, 50.0]), np.array([0.5, 1.0, 1.6]))


def integrated(place: Doubles, speed: Doubles, start: Doubles, end: Doubles, dt: float) -> Doubles:
    def slope(time: float, state: Doubles) -> Doubles:
        here, rate = state[:3], state[3:]
        asked = start + (end - start) * time / dt
        pull = SWING.frequency**2 * (asked - here) - 2.0 * SWING.ratio * SWING.frequency * rate
        return np.concatenate([rate, pull])

    found = solve_ivp(slope, (0.0, dt), np.concatenate([place, speed]), rtol=1e-10, atol=1e-12)
    return np.asarray(found.y[:, -1])


@pytest.mark.parametrize("dt", [1 / 144, 1 / 30, 0.5])
def test_a_step_is_exact(dt: float) -> None:
    rng = np.random.default_rng(0)
    place, speed, start, end = rng.random(3), rng.standard_normal(3), rng.random(3), rng.random(3)
    found = np.concatenate(SWING.step(place, speed, start, end, dt))
    assert found == pytest.approx(integrated(place, speed, start, end, dt), abs=2e-4)


def test_steps_add_up() -> None:
    place, speed = np.full(3, 0.2), np.zeros(3)
    start, end = np.zeros(3), np.ones(3)
    once = SWING.step(place, speed, start, end, 0.1)
    for index in range(10):
        place, speed = SWING.step(place, speed, np.full(3, index / 10), np.full(3, (index + 1) / 10), 0.01)
    assert np.concatenate([place, speed]) == pytest.approx(np.concatenate(once), abs=1e-9)


def test_no_time_is_no_step() -> None:
    place, speed = np.full(3, 0.2), np.ones(3)
    found = SWING.step(place, speed, np.zeros(3), np.ones(3), 0.0)
    assert (found[0] == place).all()
    assert (found[1] == speed).all()


def test_a_very_long_step_ends_at_what_is_asked() -> None:
    place, speed = SWING.step(np.zeros(3), np.zeros(3), np.ones(3), np.ones(3), 1e4)
    assert place == pytest.approx(np.ones(3))
    assert np.abs(speed).max() < 1e-9
