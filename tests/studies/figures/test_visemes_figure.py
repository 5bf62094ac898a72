from __future__ import annotations

import io

import pytest
from PIL import Image

from agentface.speech.visemes import viseme_table
from agentface.studies.figures import visemes

pytestmark = [pytest.mark.gl, pytest.mark.slow]


def test_every_viseme_of_both_faces_is_drawn_from_two_sides(monkeypatch):
    monkeypatch.setattr(visemes, "_SIZE", (40, 30))
    drawn = visemes.figures("onyx")
    assert set(drawn) == {"visemes-amber.png", "visemes-onyx.png"}
    with Image.open(io.BytesIO(drawn["visemes-onyx.png"])) as picture:
        assert picture.width > 40 * (len(viseme_table()) // 2)
        assert picture.height > 4 * 30
