from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from agentface.studies.figures import FIGURES
from agentface.studies.figures.texture import figures
from agentface.view.contact_sheet import CAPTION, GAP

pytestmark = [pytest.mark.gl, pytest.mark.slow]


def test_the_paint_is_on_the_template_and_on_both_cheeks_of_every_face():
    assert "texture" in FIGURES
    (name, content), *others = figures("amber").items()
    assert name == "texture.png"
    assert not others
    sheet = np.asarray(Image.open(BytesIO(content)).convert("RGB")).astype(int)
    blue = (sheet[..., 2] > sheet[..., 0] + 40) & (sheet[..., 2] > 90)
    width = (sheet.shape[1] - GAP) // 4
    for panel in range(4):
        shown = blue[: -CAPTION - GAP, GAP + panel * width : GAP + (panel + 1) * width - GAP]
        left, right = np.array_split(shown, 2, axis=1)
        assert min(left.sum(), right.sum()) > 60, panel
