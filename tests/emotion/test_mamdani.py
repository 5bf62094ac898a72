from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import trapezoid

from agentface.emotion.mamdani import centroid, contraction, cuts_of, rule_strengths
from agentface.emotion.sets import CONTRACTION_CENTRES, contraction_membership, intensity_membership

CUTS = st.lists(st.floats(0.0, 1.0), min_size=5, max_size=5).map(np.array).filter(lambda cuts: cuts.max() > 1e-3)


@given(st.floats(0.0, 1.0))
def test_intensity_sets_cover_every_intensity_to_one(intensity: float):
    assert intensity_membership(intensity).sum() == pytest.approx(1.0)


@pytest.mark.parametrize("number", range(5))
@pytest.mark.parametrize("cut", [1e-9, 0.3, 1.0])
def test_one_set_alone_gives_its_centre_however_weakly(number: int, cut: float):
    cuts = np.zeros(5)
    cuts[number] = cut
    assert contraction(cuts) == number / 4


@given(CUTS)
def test_the_centroid_is_that_of_the_joined_clipped_sets(cuts: np.ndarray):
    points = np.linspace(0.0, 1.0, 20_001)
    heights = np.minimum(cuts[:, None], contraction_membership(points)).max(axis=0)
    fine = trapezoid(points * heights, points) / trapezoid(heights, points)
    # Between its sample points the universe is linear, so the corners of the union are cut a little.
    assert centroid(cuts) == pytest.approx(fine, abs=2e-3)


@given(CUTS)
def test_the_centroid_is_mirrored_with_its_cuts(cuts: np.ndarray):
    assert centroid(cuts) + centroid(cuts[::-1]) == pytest.approx(2 * CONTRACTION_CENTRES[2])


@given(CUTS)
def test_a_contraction_is_a_fraction(cuts: np.ndarray):
    assert 0.0 <= contraction(cuts) <= 1.0


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_and_is_the_minimum(first: float, second: float):
    strengths = rule_strengths(np.array([first, second]))
    for i in range(5):
        for j in range(5):
            assert strengths[i, j] == min(intensity_membership(first)[i], intensity_membership(second)[j])


def test_rules_with_one_conclusion_join_by_the_maximum():
    strengths = np.array([0.2, 0.7, 0.1, 0.0, 0.0])
    assert cuts_of(strengths, np.array([0, 1, 1, 2, 2], np.int8)).tolist() == [0.2, 0.7, 0.0, 0.0, 0.0]
