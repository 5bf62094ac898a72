from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from agentface.studies.figures import lips, parallel_steps

pytestmark = [pytest.mark.gl, pytest.mark.slow]


def test_the_figures_show_the_surface_and_its_contractions(monkeypatch):
    monkeypatch.setattr(lips, "_SIDE", 90)
    monkeypatch.setattr(lips, "_PER_CELL", 1)
    drawn = lips.figures("amber")
    assert list(drawn) == ["lips.png", "orbicularis_oris.png"]
    surface, contracted = (np.asarray(Image.open(BytesIO(png)).convert("RGB"), int) for png in drawn.values())
    panels = [surface[12:102, 12 + 102 * i : 102 + 102 * i] for i in range(3)]
    assert all(np.abs(one - other).max() > 50 for i, one in enumerate(panels) for other in panels[:i])
    assert contracted.shape[1] == surface.shape[1]
    rows = [contracted[12 + 154 * row : 102 + 154 * row] for row in range(4)]
    for row in rows:
        at_rest, half, full = (row[:, 12 + 102 * i : 102 + 102 * i] for i in range(3))
        assert np.abs(full - at_rest).mean() > np.abs(half - at_rest).mean() > 0.3


def test_the_figure_of_the_steps_shows_three_ways_and_the_artists(monkeypatch):
    monkeypatch.setattr(parallel_steps, "_SIZE", (90, 78))
    (name, content), *others = parallel_steps.figures("amber").items()
    assert (name, others) == ("parallel_steps.png", [])
    drawn = np.asarray(Image.open(BytesIO(content)).convert("RGB"), int)
    for row in range(4):
        panels = (drawn[12 + 142 * row : 90 + 142 * row, 12 + 102 * i : 102 + 102 * i] for i in range(4))
        once, steps, mutual, artists = panels
        assert np.abs(artists - steps).mean() > 1.5 * np.abs(steps - mutual).mean() > 0.1
        # a squeeze is the same
        assert (np.abs(steps - once).mean() > 1.0) == (row < 3)
