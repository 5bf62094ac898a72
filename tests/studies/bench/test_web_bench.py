from __future__ import annotations

import numpy as np
import pytest

from agentface.io.web.basis import make_basis
from agentface.studies.bench import web


def test_the_errors_are_those_of_all_vertices():
    errors = np.zeros((2, 1000))
    errors[1, :2] = 4.0
    told = web._told(errors)
    assert told["rms_mm"] == pytest.approx(np.sqrt(32 / 2000))
    assert told["worst_frame_rms_mm"] == pytest.approx(np.sqrt(32 / 1000))
    assert told["max_mm"] == 4.0
    assert told["p99_9_mm"] == pytest.approx(np.quantile(errors, 0.999))


@pytest.mark.slow
def test_pages_of_another_process_get_frames(monkeypatch):
    monkeypatch.setattr(web, "basis_of", lambda face, deformer: make_basis(face.model, deformer, (40, 20)))
    monkeypatch.setattr(web, "_SECONDS", 1.0)
    monkeypatch.setattr(web, "_PAGES", 3)
    report = web.run(count=2)
    pages = report["pages"]
    assert (pages["pages"], pages["frames_shown"] > 1) == (3, True)
    assert 0.0 < pages["frames_come_of_all"] <= 1.0
    # a frame cannot come before it is there, and the clocks of both processes are one
    assert 0.0 < pages["late_ms"]["p50"] <= pages["late_ms"]["p99"]
    assert report["errors"]["exact"]["natural"]["max_mm"] <= 0.01
    assert report["frame"]["basis"]["bytes"] < report["frame"]["exact"]["bytes"]
