"""Numbers that a shader and Python both need: each stands in two files, and here they are held together."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest

from agentface.resources import data_folder
from agentface.view.gl import shadow
from agentface.view.hair import sheets
from agentface.view.skin import meshes as skin
from agentface.view.skin import wrinkle_patches


@pytest.mark.parametrize(
    ("file", "pattern", "value"),
    [
        ("atlas.glsl", r"ATLAS_AZIMUTH = ([\d.]+);", wrinkle_patches._AZIMUTH),
        ("wrinkles.glsl", r"STEEPEST = ([\d.]+);", wrinkle_patches.STEEPEST),
        ("wrinkles.glsl", r"CREASE_SHADE = ([\d.]+);", wrinkle_patches._CREASE_SHADE),
        ("shadow.glsl", r"at \+ ([\d.]+) \* n", shadow._CLEARANCE),
        ("shadow.glsl", r"q\.z - ([\d.]+)", shadow._SLACK),
        ("sheet.frag.glsl", r" CARDS = ([\d.]+);", sheets.FIRST_CARD),
        ("surface.glsl", r"SKIN_COLUMNS = (\d+);", skin._COLUMNS),
    ],
)
def test_shader_and_python_have_the_same_number(file, pattern, value):
    found = re.findall(pattern, (data_folder("shaders") / file).read_text())
    assert len(found) == 1, file
    assert math.isclose(float(found[0]), value, rel_tol=1e-9)


def test_a_byte_of_smooth_skin_means_no_relief():
    text = (data_folder("shaders") / "relief.glsl").read_text()
    even, steps = map(float, re.search(r"\(255\.0 \* texel - ([\d.]+)\) / ([\d.]+)", text).groups())
    assert (255 * (128 / 255) - even) / steps == pytest.approx(0.0)
    np.testing.assert_allclose((np.array([1, 255]) - even) / steps, [-1, 1])
