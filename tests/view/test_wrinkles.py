from __future__ import annotations

import numpy as np
import pytest
from scipy.ndimage import binary_dilation

from agentface.deform.geometry import FaceGeometry
from agentface.errors import InvalidValueError
from agentface.head.trains import heights
from agentface.mesh.normals import vertex_normals
from agentface.view.camera import named_view
from agentface.view.renderer import Renderer
from agentface.view.skin.wrinkle_patches import SIDE, STEEPEST, deep_places, depth_left
from tests.heads import head_model

pytestmark = pytest.mark.gl

SIZE = (320, 240)


@pytest.fixture(scope="module", params=["amber", "onyx"])
def renderer(request):
    with Renderer(head_model(request.param)) as renderer, renderer.current():
        yield renderer


def at_rest(model, **levels):
    geometry = FaceGeometry.at_rest(model)
    for i, placed in enumerate(model.trains):
        geometry.wrinkle_levels[i] = levels.get(placed.name, levels.get(placed.name[:-2], 0.0))
    return geometry


def spread(renderer, **levels):
    atlas = renderer._wrinkles
    assert atlas.update(at_rest(renderer.model, **levels).wrinkle_levels)
    return atlas.heights.copy()


def places(model, atlas):
    """The atlas' columns and rows of the vertices, and which of them lie on it and face outward."""
    azimuth = np.arctan2(model.vertices[:, 0], model.vertices[:, 2])
    low, high = atlas.height
    column = SIDE * (0.5 + 0.5 * azimuth / 1.35) - 0.5
    row = SIDE * (model.vertices[:, 1] - low) / (high - low) - 0.5
    outward = (vertex_normals(model.vertices, model.triangles)[:, [0, 2]] * model.vertices[:, [0, 2]]).sum(
        axis=1
    ) > 0.03
    return np.round(column).astype(int), np.round(row).astype(int), outward & (np.abs(azimuth) < 1.2)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["forehead_medial", "glabella", "crows_feet", "nasolabial_smile"])
def test_the_atlas_holds_the_heights_of_the_skin(renderer, name):
    model = renderer.model
    texels = spread(renderer, **{f"{name}_l": 1.0})
    placed = next(placed for placed in model.trains if placed.name == f"{name}_l")
    expected = placed.reach * heights(placed.train, model.vertices)
    column, row, shown = places(model, renderer._wrinkles)
    shown &= expected > 0.3 * placed.train.height
    assert shown.sum() > 5
    left = depth_left(placed, deep_places(model.name))[row[shown], column[shown]]
    gap = np.abs(texels[row[shown], column[shown]] - left * expected[shown])
    assert np.median(gap) < 0.1 * placed.train.height


def test_lines_are_broken_and_not_the_same_on_two_people():
    amber, onyx = (deep_places(name) for name in ("amber", "onyx"))
    np.testing.assert_array_equal(amber, deep_places("amber"))
    for one, other in ((amber, onyx), (amber, amber[:, ::-1])):
        assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.2
    for field in (amber, onyx):
        assert field.min() < 0.1
        assert field.max() > 0.9
        assert np.abs(np.diff(field, axis=0)).max() < 0.12, "no edges"


def test_no_train_ends_in_a_step(renderer):
    for placed, patch in zip(renderer.model.trains, renderer._wrinkles.patches, strict=True):
        height, most = patch.heights, 0.02 * placed.train.height
        assert max(height[0].max(), height[-1].max()) <= most, placed.name
        inner = [height[:, 0]] * (patch.columns.start > 0) + [height[:, -1]] * (patch.columns.stop < SIDE)
        assert all(column.max() <= most for column in inner), placed.name


def test_one_side_of_the_atlas_is_the_others_mirror_image_but_for_what_is_broken(renderer):
    model = renderer.model
    (left, right), deep = (
        (spread(renderer, **{f"nasolabial_smile_{side}": 0.7}) for side in "lr"),
        deep_places(model.name),
    )
    part = depth_left(next(placed for placed in model.trains if placed.name == "nasolabial_smile_l"), deep)
    assert left.max() > 0.4e-3
    np.testing.assert_allclose(left / part, (right / part)[:, ::-1], atol=2e-5)


def test_the_highest_train_stands_and_the_last_frame_is_forgotten(renderer):
    one, other = spread(renderer, forehead_medial=0.5), spread(renderer, forehead_middle=1.0, glabella=0.3)
    both = spread(renderer, forehead_medial=0.5, forehead_middle=1.0, glabella=0.3)
    np.testing.assert_allclose(both, np.maximum(one, other), atol=1e-9)
    np.testing.assert_array_equal(spread(renderer, forehead_medial=0.5), one)
    np.testing.assert_allclose(spread(renderer, forehead_medial=1.0), 2 * one, atol=1e-9)


def test_the_texture_holds_the_slopes_of_the_heights(renderer):
    atlas = renderer._wrinkles
    for levels in ({"forehead_medial": 0.5, "glabella": 1.0}, {"crows_feet": 0.7}):  # the first must be forgotten
        heights = spread(renderer, **levels)
        root = (atlas.texels[..., 1].astype(float) - 128) / 127
        expected = np.gradient(heights, (atlas.height[1] - atlas.height[0]) / SIDE, axis=0)
        gap = np.abs(STEEPEST * root * np.abs(root) - expected)[heights > 1e-5]
        assert np.median(gap) < 0.005 < 0.05 < np.abs(expected).max()
    shown = np.frombuffer(atlas.texture.read(), np.uint8).reshape(SIDE, SIDE, 4)
    np.testing.assert_array_equal(shown, atlas.texels)
    assert (shown[heights == 0][..., :3] == 128).all()


def test_a_slope_towards_the_key_light_is_brighter(renderer):
    up = np.array([0.0, 0.8, 0.6])
    for placed, patch in zip(renderer.model.trains, renderer._wrinkles.patches, strict=True):
        if placed.name.startswith("forehead"):
            shade, rise = patch.shade(up), patch.slopes[..., 1]
            assert shade[rise < -0.1].max() > 0 > shade[rise > 0.1].min()
            assert (shade * rise <= 1e-3).mean() > 0.9


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("quality", ["fast", "portrait"])
@pytest.mark.parametrize("name", ["forehead_medial", "nose_side", "crows_feet"])
def test_a_picture_changes_where_the_train_is_and_nowhere_else(renderer, name, quality):
    model = renderer.model
    smooth = renderer.render(at_rest(model), SIZE, "front", quality).astype(int)
    wrinkled = renderer.render(at_rest(model, **{name: 1.0}), SIZE, "front", quality).astype(int)
    changed = np.abs(wrinkled - smooth).max(axis=2) > 2
    raised = np.zeros(len(model.vertices), bool)
    for placed in model.trains:
        if placed.name[:-2] == name:
            raised |= placed.reach * heights(placed.train, model.vertices) > 0.0
    triangles = model.triangles[raised[model.triangles].any(axis=1)]
    allowed = binary_dilation(_shown(model, triangles), iterations=6)
    assert changed.sum() > 40
    assert not (changed & ~allowed).any()
    np.testing.assert_array_equal(renderer.render(at_rest(model), SIZE, "front", quality), smooth)


def _shown(model, triangles):
    """Pixels near the corners and the middles of triangles."""
    camera = named_view(model, "front")
    corners = model.vertices[triangles]
    points = np.concatenate([corners.reshape(-1, 3), corners.mean(axis=1), 0.5 * (corners[:, 0] + corners[:, 1])])
    clip = np.c_[points, np.ones(len(points))] @ (camera.projection(SIZE[0] / SIZE[1]) @ camera.view()).T
    x, y = (clip[:, i] / clip[:, 3] for i in (0, 1))
    mask = np.zeros(SIZE[::-1], bool)
    column, row = (0.5 + 0.5 * x) * SIZE[0], (0.5 - 0.5 * y) * SIZE[1]
    inside = (column >= 0) & (column < SIZE[0]) & (row >= 0) & (row < SIZE[1])
    mask[row[inside].astype(int), column[inside].astype(int)] = True
    return mask


def test_deeper_wrinkles_change_the_picture_more(renderer):
    model = renderer.model
    smooth = renderer.render(at_rest(model), SIZE).astype(int)
    gaps = [
        np.abs(renderer.render(at_rest(model, forehead_medial=level, forehead_middle=level), SIZE) - smooth).sum()
        for level in (0.25, 0.5, 1.0)
    ]
    assert gaps[0] < gaps[1] < gaps[2]


def test_levels_of_other_trains_are_refused(renderer):
    for wrong in (len(renderer.model.trains) - 1, 0):
        with pytest.raises(InvalidValueError, match=r"geometry\.wrinkle_levels: expected an array of shape"):
            renderer._wrinkles.update(np.ones(wrong, np.float32))
