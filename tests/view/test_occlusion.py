import numpy as np
import pytest

from agentface.head.build.occlusion import ambient_light, half_sphere
from tests.heads import head_model


def grid(side, height):
    """A square plate of two triangles a cell, facing up (+Y)."""
    n = 21
    x, z = np.meshgrid(np.linspace(-side, side, n), np.linspace(-side, side, n), indexing="ij")
    vertices = np.stack([x.ravel(), np.full(n * n, height), z.ravel()], axis=1)
    i = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    triangles = np.concatenate([np.stack([i, i + 1, i + n], 1), np.stack([i + 1, i + n + 1, i + n], 1)])
    mirror = np.arange(n * n).reshape(n, n)[::-1].ravel()
    return vertices, triangles.astype(np.int32), mirror.astype(np.int32)


def test_an_open_plate_sees_the_whole_sky():
    vertices, triangles, mirror = grid(0.05, 0.0)
    np.testing.assert_allclose(ambient_light(vertices, triangles, mirror, []), 1.0)


@pytest.mark.slow
def test_a_plate_above_takes_the_light_that_its_form_factor_says():
    vertices, triangles, mirror = grid(0.15, 0.0)
    above, cover, _ = grid(0.15, 0.15)
    light = ambient_light(vertices, triangles, mirror, [(above, cover)])
    middle = len(vertices) // 2
    # a point under the middle of a square plate as high as half its side (four corner form factors)
    x = y = 1.0
    u, v = x / np.hypot(1, x), y / np.hypot(1, y)
    factor = 4 / (2 * np.pi) * (u * np.arctan(y / np.hypot(1, x)) + v * np.arctan(x / np.hypot(1, y)))
    assert light[middle] == pytest.approx(1 - factor, abs=0.06)
    assert light[0] > light[middle]


def test_directions_are_units_and_their_mirror_images_cover_the_sphere():
    half = half_sphere(56)
    np.testing.assert_allclose(np.linalg.norm(half, axis=1), 1)
    assert (half[:, 0] > 0).all()
    whole = np.concatenate([half, half * [-1, 1, 1]])
    np.testing.assert_allclose(whole.mean(0), 0, atol=0.03)
    np.testing.assert_allclose(whole.T @ whole / len(whole), np.eye(3) / 3, atol=0.04)


@pytest.mark.parametrize("face", ["amber", "onyx"])
def test_baked_light_is_bright_on_the_forehead_dark_in_the_mouth_and_symmetric(face):
    model = head_model(face)
    light = model.shade[:, 0]
    forehead = np.linalg.norm(model.vertices - model.landmarks["hairline_middle"], axis=1).argmin()
    assert light[forehead] > 0.95
    assert light[model.material[:, 1] > 0.9].mean() < 0.3
    np.testing.assert_array_equal(light, light[model.mirror])
