from __future__ import annotations

import numpy as np
import pytest

from agentface.studies.figures.gouraud import fill
from agentface.studies.figures.mesh_view import MeshView
from agentface.studies.figures.solids import FINER, Scene

SQUARE = np.array([[-0.01, -0.01, 0], [0.01, -0.01, 0], [0.01, 0.01, 0], [-0.01, 0.01, 0]])
HALVES = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
RED, BLUE = np.array([200.0, 20.0, 20.0]), np.array([20.0, 20.0, 200.0])


def scene(size=40):
    return Scene(MeshView(np.zeros(3, np.float32), 0.04, 0.0, size))


@pytest.mark.parametrize("scale", [1.0, 0.05, 37.0])
def test_triangles_of_any_size_cover_each_pixel_of_a_square_once(scale):
    """A square of pixels 3..35 and its parts: the diagonal is in neither half twice, and no pixel is left out."""
    side = 38
    corners = np.array([[3.0, 3.0], [35.0, 3.0], [35.0, 35.0], [3.0, 35.0]])
    corners = 19.0 + scale * (corners - 19.0)
    points = np.column_stack([corners, np.zeros(4)])
    drawn, near = np.zeros((side, side, 1)), np.full((side, side), -np.inf)
    fill(drawn, near, points[HALVES], np.ones((2, 3, 1)))
    centre = np.arange(side) + 0.5
    inside = (centre > corners[0, 0]) & (centre < corners[2, 0])
    np.testing.assert_array_equal(drawn[..., 0] > 0.5, inside[:, None] & inside)
    np.testing.assert_array_equal(np.isfinite(near), inside[:, None] & inside)


def test_a_value_is_interpolated_and_cuts_where_it_is_negative():
    points = np.array([[0.0, 0.0, 0.0], [32.0, 0.0, 0.0], [32.0, 32.0, 0.0], [0.0, 32.0, 0.0]])
    own = np.array([[-1.0], [1.0], [1.0], [-1.0]])[HALVES]
    drawn, near = np.full((32, 32, 1), np.nan), np.full((32, 32), -np.inf)
    fill(drawn, near, points[HALVES], own, cuts=1)
    assert np.isnan(drawn[:, :16]).all()
    np.testing.assert_allclose(drawn[:, 16:, 0], np.tile((np.arange(16, 32) + 0.5) / 16.0 - 1.0, (32, 1)), atol=1e-12)


def test_a_triangle_seen_from_its_edge_is_not_drawn_and_does_not_warn():
    drawn, near = np.zeros((8, 8, 1)), np.full((8, 8), -np.inf)
    fill(drawn, near, np.array([[[1.0, 1, 0], [4, 4, 0], [7, 7, 0]]]), np.ones((1, 3, 1)))
    assert not drawn.any()


@pytest.mark.parametrize("first", ["near", "far"])
def test_the_nearer_thing_is_seen_whatever_comes_first(first):
    drawn = scene()
    far = SQUARE * 1.6 - [0, 0, 0.01]
    for points, colour in [(SQUARE, RED), (far, BLUE)][:: 1 if first == "near" else -1]:
        drawn.surface(points, HALVES, colour)
    picture = drawn.picture().astype(int)
    assert picture.shape == (40, 40, 3)
    red, _, blue = picture[20, 20]
    assert red > 2 * blue
    red, _, blue = picture[20, 6]
    assert blue > 2 * red
    assert (picture[0, 0] == 255).all()


def test_lines_end_where_a_surface_hides_them():
    drawn = scene(80)
    drawn.surface(SQUARE, HALVES, np.full(3, 250.0))
    line = np.array([[-0.019, 0.005, -0.004], [0.019, 0.005, -0.004], [-0.019, -0.005, 0.004], [0.019, -0.005, 0.004]])
    drawn.net(line, np.array([[0, 1], [2, 3]], np.int32), (0, 0, 0, 255), 1.0)
    dark = drawn.picture().max(axis=2) < 120
    behind, before = dark[28:32].any(axis=0), dark[48:52].any(axis=0)
    assert before[4:76].all()
    assert not behind[24:56].any()
    assert behind[4:14].all()
    assert behind[66:76].all()


def test_a_hollow_is_darker_than_a_plain():
    x, y = np.meshgrid(np.linspace(-0.018, 0.018, 61), np.linspace(-0.018, 0.018, 61))
    corner = (np.arange(60)[:, None] * 61 + np.arange(60)).ravel()
    quads = np.stack([corner, corner + 1, corner + 62, corner + 61], axis=1)
    triangles = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)
    middles = []
    for depth in (0.0, 0.012):
        z = -depth * np.exp(-(x**2 + y**2) / 0.004**2)
        drawn = scene(60)
        drawn.surface(np.stack([x, y, z], axis=-1).reshape(-1, 3), triangles, np.full(3, 200.0))
        middles.append(int(drawn.picture()[30, 30, 0]))
    assert middles[1] < 0.7 * middles[0]


def test_the_scene_is_drawn_finer_than_its_picture():
    assert FINER == 2
    assert scene(30).picture().shape == (30, 30, 3)
