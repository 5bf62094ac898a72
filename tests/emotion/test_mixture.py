from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from scipy.optimize import nnls

from agentface.emotion import mixture
from agentface.emotion.mixture import mixtures
from agentface.emotion.vocabularies import published

PAD = published()["pad-dimensions"].six
POINTS = arrays(float, (3,), elements=st.floats(-1, 1, width=16))


@pytest.mark.parametrize("name", ["pad-dimensions", "fsre-dimensions", "scherer-appraisals", "ema-appraisals"])
def test_where_an_emotion_stands_it_is_shown(name):
    six = published()[name].six
    weights = mixtures(six.T.copy(), six)
    assert (weights.argmax(axis=1) == np.arange(6)).all()
    assert np.diag(weights).min() > 0.55
    assert np.sort(np.diag(weights))[1] > 0.8


def by_another_method(point, doubts):
    """The same problem for scipy: the square of a stack, its linear term completed."""
    direction = point / np.linalg.norm(point)
    gram = PAD.T @ PAD + np.diag(np.full(6, mixture._SPREAD + doubts))
    root = np.linalg.cholesky(gram).T
    return nnls(root, np.linalg.solve(root.T, PAD.T @ direction - mixture._PRICE))[0]


@given(POINTS.filter(lambda point: np.linalg.norm(point) > 1e-2), st.sampled_from([0.0, 0.5]))
def test_the_weights_are_those_of_another_solver(point, doubts):
    expected = by_another_method(point, doubts)
    length = 0.01 / np.linalg.norm(point)  # so near to the middle that nothing is cut at 1
    found = mixtures(point[None] * length, PAD, np.full(6, doubts))[0] / 0.01
    lifted = found.sum() / expected.sum() if expected.sum() else 1.0
    assert 1.0 - 1e-6 <= lifted <= mixture._MOST_MADE_UP + 1e-6
    assert found == pytest.approx(expected * lifted, abs=1e-6)


@given(POINTS, st.floats(0.0, 1.0))
def test_half_as_far_is_half_as_strong(point, share):
    whole = mixtures(point[None] * 0.2, PAD)
    assert mixtures(point[None] * 0.2 * share, PAD) == pytest.approx(whole * share, abs=1e-9)


@given(POINTS, POINTS)
def test_near_points_look_alike(point, step):
    beside = point + 1e-4 * step
    assert mixtures(beside[None], PAD) == pytest.approx(mixtures(point[None], PAD), abs=0.02)


def test_many_points_are_as_one_by_one():
    points = np.random.default_rng(0).uniform(-1, 1, (1100, 3))
    together = mixtures(points, PAD)
    assert together.shape == (1100, 6)
    assert together[[0, 511, 512, 1099]] == pytest.approx(
        np.vstack([mixtures(points[[row]], PAD) for row in (0, 511, 512, 1099)])
    )
    assert ((together >= 0.0) & (together <= 1.0)).all()


def test_the_middle_is_no_emotion():
    assert not mixtures(np.zeros((2, 3)), PAD).any()
