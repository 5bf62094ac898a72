from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from agentface.head.trains import heights
from agentface.mesh.normals import corner_normals
from agentface.studies.figures.gouraud import smooth_picture
from agentface.studies.figures.mesh_view import SKIN, MeshView
from agentface.studies.figures.wrinkles import TRAIN, figures, skin_strip

VIEW = MeshView(np.zeros(3, np.float32), 0.02, 0.0, 40)


def test_a_triangles_light_is_interpolated_between_its_corners():
    points = np.array([[-0.01, -0.01, 0], [0.01, -0.01, 0], [0.01, 0.01, 0], [-0.01, 0.01, 0]])
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    up, down = np.array([0.0, 1.0, 0.0]), np.array([0.0, -1.0, 0.0])
    normals = np.where((points[triangles][..., 1] > 0)[..., None], up, down)
    picture = smooth_picture(VIEW, points, triangles, normals).astype(int)
    rows = picture[:, 10, 0]
    assert (np.diff(rows) <= 0).all()
    assert rows[0] - rows[-1] > 80
    np.testing.assert_allclose(picture / SKIN, (picture[..., :1] / SKIN[0]) * np.ones(3), atol=0.01)


def test_what_is_nearer_hides_what_is_farther_and_the_rest_is_white():
    near = np.array([[-0.005, -0.005, 0.01], [0.005, -0.005, 0.01], [0, 0.005, 0.01]])
    points = np.concatenate([near, near * [1, 1, -1]])
    triangles = np.array([[0, 1, 2], [3, 4, 5]], np.int32)
    facing = np.zeros((2, 3, 3))
    facing[0, :] = [0.0, 1.0, 0.0]  # lit; the other one is not
    for order in ([0, 1], [1, 0]):
        picture = smooth_picture(VIEW, points, triangles[order], facing[order]).astype(int)
        assert picture[20, 20, 0] > 0.8 * SKIN[0]
        assert (picture[0, 0] == 255).all()


def test_the_strips_rows_lie_on_the_feet():
    points, triangles, feet = skin_strip(TRAIN)
    rows = np.unique(np.round(points[feet][:, 1], 9))
    assert len(rows) == TRAIN.count - 1
    np.testing.assert_allclose(points[feet][:, 2], 0.0, atol=1e-9)
    np.testing.assert_allclose(points[:, 2], heights(TRAIN, points * [1, 1, 0]), atol=1e-12)
    with_, without = (corner_normals(points, triangles, mask) for mask in (feet, np.zeros_like(feet)))
    touched = feet[triangles]
    np.testing.assert_array_equal(with_[~touched], without[~touched])
    assert with_[touched][:, 2].min() < 0.9 * without[touched][:, 2].min()


@pytest.mark.slow
@pytest.mark.gl
def test_the_figures_show_the_correction_and_the_forehead():
    drawn = figures("amber")
    assert set(drawn) == {"wrinkle-normals.png", "wrinkles.png"}
    assert all(len(content) < 300_000 for content in drawn.values())
    with Image.open(BytesIO(drawn["wrinkle-normals.png"])) as image:
        pixels = np.asarray(image.convert("L"), int)
    half = pixels.shape[1] // 2
    # the steepest step from row to row: only the corrected panel has sharp valleys
    smooth, sharp = (
        np.abs(np.diff(part[150:300, 180:220], axis=0)).max() for part in np.split(pixels[:, : 2 * half], 2, 1)
    )
    assert sharp > 2 * smooth
