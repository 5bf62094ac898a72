from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.state import EMOTIONS
from agentface.studies.bench.texture import _axes, _frames, _share, run
from agentface.view.gl.quality import QUALITIES

pytestmark = pytest.mark.slow


@given(st.floats(0.3, 3.0), st.floats(0.3, 3.0), st.floats(0.0, 6.3))
def test_the_axes_are_what_a_plane_was_stretched_by(wide, high, turn):
    turned = np.array([[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]])
    corners = np.array([[[0.0, 0.0, 0.0], [0.7, 0.1, 0.0], [0.2, 0.9, 0.0]]])
    stretched = corners @ np.diag([wide, high, 1.0]) @ turned.T
    axes = _axes(_frames(stretched) @ np.linalg.inv(_frames(corners)))
    np.testing.assert_allclose(axes[0], sorted([wide, high], reverse=True), rtol=1e-9)


def test_a_share_is_of_the_weight():
    values, weights = np.array([3.0, 1.0, 2.0]), np.array([1.0, 0.0, 9.0])
    assert [_share(values, weights, part) for part in (0.05, 0.5, 0.95)] == [2.0, 2.0, 3.0]


@pytest.mark.gl
def test_the_report_says_what_a_picture_costs_and_keeps():
    report = run(rounds=1, size=(64, 48))
    finer, coarser = (report["texels_a_mm"][name] for name in ("finer", "coarser"))
    assert 2 < coarser["p5"] < coarser["p50"] < finer["p50"] < finer["p95"] < 20
    assert report["strain"].keys() == set(EMOTIONS)
    for strain in report["strain"].values():
        assert strain["squeeze_p5"] < 1 < strain["stretch_p95"]
    for quality in QUALITIES:
        kept = report[quality]["kept_levels"]
        assert 0 < kept["p50"] <= 2
        assert kept["p99"] <= 8
        assert report[quality]["worn_to_plain_ratio"] > 0
