from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from agentface.errors import GraphicsError
from agentface.studies.figures import window
from tests.tools import require

pytestmark = pytest.mark.gl


@pytest.mark.slow
def test_the_window_is_photographed_with_its_panel():
    require("xvfb-run", "xauth")
    with Image.open(BytesIO(window.figures("amber")["window.png"])) as image:
        picture = np.asarray(image.convert("RGB"), int)
    assert picture.shape == (window.SIZE[1], window.SIZE[0], 3)
    face, panel = picture[:, :900], picture[:, 960:]
    red, green, blue = np.median(face[350:600, 350:600].reshape(-1, 3), axis=0)
    assert red > green > blue > 60, "skin in the middle of the face"
    ground = (np.abs(panel - [27, 28, 31]).max(axis=2) < 8).mean()
    assert ground > 0.3, "the panel's ground"
    assert panel.max() > 200, "its letters"


def test_without_a_virtual_display_it_says_what_brings_one(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(GraphicsError, match=r"apt-get install .* xvfb xauth"):
        window.figures("amber")


@pytest.mark.slow
def test_a_window_that_does_not_open_says_why(monkeypatch):
    require("xvfb-run", "xauth")
    with pytest.raises(GraphicsError, match="'nobody'"):
        window.figures("nobody")
