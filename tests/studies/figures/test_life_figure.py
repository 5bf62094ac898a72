from __future__ import annotations

import io

import pytest
from PIL import Image

from agentface.studies.figures import life

pytestmark = [pytest.mark.gl, pytest.mark.slow]


def test_every_tenth_frame_is_drawn(monkeypatch):
    monkeypatch.setattr(life, "_SIZE", (40, 44))
    monkeypatch.setattr(life, "FRAMES", 21)
    (drawn,) = life.figures("amber").values()
    with Image.open(io.BytesIO(drawn)) as picture:
        assert picture.width > 3 * 40
        assert picture.height > 44
