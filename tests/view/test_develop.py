"""The film curve of ``shaders/develop.glsl``, against the formulas that it stands for."""

from __future__ import annotations

import re

import numpy as np

from agentface.resources import data_folder


def test_one_quotient_of_the_root_is_the_film_curve_in_srgb():
    text = (data_folder("shaders") / "develop.glsl").read_text()
    body = re.search(r"return clamp\((.+), 0\.0, 1\.0\);", text)
    assert body, "finish() has one clamped formula"
    x = np.concatenate([np.linspace(0, 1, 4001), np.linspace(1, 12, 2001)])
    fast = np.clip(eval(body[1], {}, {"x": x, "root": np.sqrt(x)}), 0, 1)  # noqa: S307 - our own shader, arithmetic that GLSL and Python share
    film = np.clip(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0, 1)
    srgb = np.where(film <= 0.0031308, 12.92 * film, 1.055 * film ** (1 / 2.4) - 0.055)
    assert np.abs(fast - srgb).max() < 0.8 / 255
    assert (np.diff(fast) >= 0).all()
