"""Principal modes, beside a whole decomposition."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.io.web.modes import principal_modes, stored


@pytest.fixture
def samples():
    rng = np.random.default_rng(4)
    lengths = 0.8 ** np.arange(60)
    return (rng.standard_normal((90, 60)) * lengths @ np.linalg.qr(rng.standard_normal((120, 60)))[0].T).astype(
        np.float32
    )


def test_no_others_hold_more(samples):
    rows = principal_modes(samples, 20, np.random.default_rng(1))
    np.testing.assert_allclose(rows @ rows.T, np.eye(20), atol=1e-5)
    best = np.sqrt((np.linalg.svd(samples, compute_uv=False)[20:] ** 2).sum())
    assert np.linalg.norm(samples - samples @ rows.T @ rows) == pytest.approx(best, rel=1e-3)


def test_there_are_no_more_than_the_samples_have():
    samples = np.zeros((30, 12), np.float32)
    samples[:, :2] = np.random.default_rng(2).standard_normal((30, 2))
    assert len(principal_modes(samples, 10, np.random.default_rng(1))) == 2
    assert len(principal_modes(samples[:1], 10, np.random.default_rng(1))) == 1


def test_the_same_samples_give_the_same_modes(samples):
    first, second = (principal_modes(samples, 5, np.random.default_rng(1)) for _ in range(2))
    np.testing.assert_array_equal(first, second)


def test_modes_in_whole_numbers_move_as_far(samples):
    rows = principal_modes(samples, 20, np.random.default_rng(1))
    reach = np.abs(samples @ rows.T).max(axis=0)
    modes = stored(rows, reach)
    assert modes.shapes.dtype == np.int16
    weights = (rows @ samples[3]) / reach
    assert np.abs(weights).max() <= 1.0 + 1e-6
    np.testing.assert_allclose(
        modes.moved(weights).ravel(), rows.T @ (rows @ samples[3]), atol=1e-3 * np.abs(samples[3]).max()
    )
