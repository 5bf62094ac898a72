import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform.pipeline import GeometricDeformer
from agentface.head.look import load_look
from agentface.head.model import load_model
from agentface.mesh.normals import vertex_normals
from agentface.parameters import FacePose
from agentface.view.camera import named_view
from agentface.view.hair import strands as strands_module
from agentface.view.hair.brows import BrowLine, brow_hairs, lash_hairs
from agentface.view.hair.cap import scalp_cap
from agentface.view.hair.groom import groom
from agentface.view.hair.hairline import Hairline, hair_shade
from agentface.view.hair.hull import Hull
from agentface.view.hair.ribbons import roots_along, roots_in_front
from agentface.view.hair.visible import unhidden
from agentface.view.renderer import Renderer


@pytest.fixture(scope="module", params=["amber", "onyx"])
def grown(request):
    model = load_model(request.param)
    look = load_look(model).hair
    normals = vertex_normals(model.vertices, model.triangles)
    rng = np.random.default_rng(1)
    return model, look, normals, [brow_hairs(model, normals, look, rng), lash_hairs(model, normals, look, rng)]


def turned(angles):
    (sx, sy, sz), (cx, cy, cz) = np.sin(angles), np.cos(angles)
    return (
        np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
        @ np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
        @ np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    )


@pytest.mark.slow
@pytest.mark.untraced
@settings(max_examples=20)
@given(st.tuples(*[st.floats(-3, 3)] * 3), st.tuples(*[st.floats(-1, 1)] * 3), st.floats(0, 1))
def test_hairs_move_rigidly_with_a_rigid_skin(angles, shift, t):
    model = load_model("amber")
    normals = vertex_normals(model.vertices, model.triangles)
    hairs = brow_hairs(model, normals, load_look(model).hair, np.random.default_rng(1))
    turn = turned(angles)
    before = hairs.curve(model.vertices, normals, t)
    after = hairs.curve((model.vertices @ turn.T + shift).astype(np.float32), (normals @ turn.T).astype(np.float32), t)
    np.testing.assert_allclose(after, before @ turn.T + shift, atol=2e-6)


def test_brows_rise_with_the_skin(grown):
    model, _, normals, (brows, _) = grown
    raised = model.vertices + model.shapes["browInnerUp"].dense(len(model.vertices))
    move = brows.curve(raised, normals, 1.0) - brows.curve(model.vertices, normals, 1.0)
    inner = np.abs(brows.curve(model.vertices, normals, 0.0)[:, 0]) < model.landmarks["brow_middle_l"][0] * 0.7
    skin = model.shapes["browInnerUp"].dense(len(model.vertices))[:, 1].max()
    assert 0.4 * skin < move[inner, 1].mean() < 1.2 * skin


def test_brows_lie_where_the_landmarks_are(grown):
    model, _, normals, (brows, _) = grown
    roots = brows.curve(model.vertices, normals, 0.0)
    left = roots[roots[:, 0] > 0]
    assert len(left) == len(brows) // 2
    unit = model.landmarks.eye_separation
    for name in ("inner", "middle", "outer"):
        away = np.linalg.norm(left - model.landmarks[f"brow_{name}_l"], axis=1)
        assert away.min() < 0.06 * unit
    assert abs(left.mean(0)[1] - model.landmarks["brow_middle_l"][1]) < 0.15 * unit


def test_brows_grow_out_of_the_skin_and_lashes_away_from_the_eye(grown):
    model, _, normals, (brows, lashes) = grown
    roots, axes = brows.roots.frames(model.vertices, normals)
    assert (((brows.curve(model.vertices, normals, 0.5) - roots) * axes[:, :, 2]).sum(1) > 0).all()
    roots, tips = (lashes.curve(model.vertices, normals, t) for t in (0.0, 1.0))
    eyes = np.where(roots[:, :1] > 0, model.eye_centre("l"), model.eye_centre("r"))
    assert (np.linalg.norm(tips - eyes, axis=1) > np.linalg.norm(roots - eyes, axis=1) + 0.0005).all()
    upper = roots[:, 1] > np.median(roots[:, 1])
    assert (tips[upper, 1] > roots[upper, 1]).mean() > 0.95
    for hairs in (brows, lashes):
        reach = np.linalg.norm(hairs.tips, axis=1)
        assert reach.min() > 0.0005
        assert reach.max() < 0.014


def test_the_same_generator_gives_the_same_hairs(grown):
    model, look, normals, (brows, _) = grown
    again = brow_hairs(model, normals, look, np.random.default_rng(1))
    np.testing.assert_array_equal(again.tips, brows.tips)
    np.testing.assert_array_equal(again.paint, brows.paint)


def test_roots_are_found_where_they_were_asked_for(grown):
    model, _, _, _ = grown
    rng = np.random.default_rng(3)
    line = BrowLine(model)
    x, y = line.place(rng.random(40))
    roots = roots_in_front(np.stack([x, y], axis=1), model.vertices, model.triangles)
    placed = (model.vertices[roots.corners] * roots.weights[..., None]).sum(1)
    np.testing.assert_allclose(placed[:, :2], np.stack([x, y], axis=1), atol=1e-5)
    assert (placed[:, 2] > 0.03).all()  # on the face, not on the back of the head
    np.testing.assert_allclose(roots.weights.sum(1), 1, atol=1e-6)


def test_roots_along_a_line_are_spread_by_length():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [4, 0, 0]], np.float32)
    roots = roots_along(np.array([0, 1, 2], np.int32), vertices, np.array([0.0, 0.25, 0.5, 1.0]))
    placed = (vertices[roots.corners] * roots.weights[..., None]).sum(1)
    np.testing.assert_allclose(placed[:, 0], [0, 1, 2, 4], atol=1e-6)


def test_hair_covers_the_crown_and_leaves_the_face_and_ears_free(grown):
    model, look, _normals, _ = grown
    line = Hairline(model, look.hairline)
    over = line.over(model)
    assert over[model.vertices[:, 1].argmax()] > 0.01
    for name in ("glabella", "brow_outer_l", "brow_outer_r", "cheekbone_l", "nose_tip", "menton", "ear_front_l"):
        assert line.behind(model.landmarks[name][None])[0] < 0
    ears = (model.vertices[:, 1] < 0.05 * model.landmarks.eye_separation) & (model.material[:, 3] > 0.98)
    assert ears.any()
    assert over[ears].max() < 0
    cap = scalp_cap(model, line, look)
    assert cap.anchors.shape == (len(cap.vertices), 4)
    # hair stands off the skin by some millimetres, never under it
    gap = np.linalg.norm(cap.vertices - model.vertices[cap.anchors].mean(1), axis=1)
    assert gap.max() < 0.03


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("quality", ["fast", "portrait"])
@pytest.mark.parametrize("style", ["cropped", "swept", "bob", "bun"])
def test_strands_grow_on_the_scalp_and_stay_out_of_head_and_face(grown, style, quality):
    model, look, normals, _ = grown
    look = look.model_copy(update={"style": style})
    strands = groom(model, normals, look, quality, np.random.default_rng(5))
    roots = strands.points[:, 0]
    behind = Hairline(model, look.hairline).behind(roots)
    on_scalp = np.linalg.norm(roots - model.vertices[strands.anchors], axis=1) < 0.02
    assert on_scalp.mean() > 0.8  # a bun has none
    assert behind[on_scalp].min() > -0.008
    hull = Hull(model, ears=style == "bob")
    assert np.quantile(hull.height(strands.points[on_scalp].astype(float)), 0.01) > -0.004
    eyes = model.landmarks["pupil_l"]
    before = strands.points[..., 2] > eyes[2] - 0.02
    lower = strands.points[..., 1] < model.landmarks["brow_outer_l"][1]
    inner = np.abs(strands.points[..., 0]) < model.landmarks["brow_outer_l"][0]
    assert not (before & lower & inner).any()
    assert np.isfinite(strands.points).all()
    assert 0 <= strands.cover.min() <= strands.cover.max() <= 1
    assert 0 < strands.fine <= len(strands)


def test_the_same_generator_gives_the_same_strands(grown):
    model, look, normals, _ = grown
    first, again, other = (groom(model, normals, look, "fast", np.random.default_rng(seed)) for seed in (3, 3, 4))
    for name in ("points", "anchors", "radii", "paint", "cover"):
        assert getattr(first, name).tobytes() == getattr(again, name).tobytes()
    assert first.points.tobytes() != other.points.tobytes()


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.parametrize("style", ["swept", "bob", "bun"])
def test_hair_left_out_is_not_missed(grown, style, monkeypatch):
    model, own, _, _ = grown
    look = load_look(model)
    look = look.model_copy(update={"hair": own.model_copy(update={"style": style})})
    renderer = Renderer(model, look)
    geometry = GeometricDeformer(model, compiled=False).at(FacePose.of(jaw_open=0.6))
    for yaw, pitch in ((0.1, 0.1), (-0.6, 0.1), (1.7, -0.1), (2.9, 0.2)):
        camera = named_view(model, "front").orbited(yaw, pitch)
        monkeypatch.undo()
        chosen = renderer.render(geometry, (240, 260), camera).astype(int)
        monkeypatch.setattr(strands_module, "_NEAR", 99.0)  # all of it
        whole = renderer.render(geometry, (240, 260), camera).astype(int)
        assert (np.abs(chosen - whole).max(2) > 24).mean() < 0.008


def test_what_is_behind_much_hair_is_left_out_and_the_nearest_comes_first():
    across, down = np.meshgrid(np.linspace(-0.1, 0.1, 81), np.linspace(-0.1, 0.1, 9))
    flat = np.stack([across.T, down.T, np.zeros_like(across.T)], axis=2).astype(np.float32)  # a curtain
    behind, before = flat[40:41] - np.float32([0, 0, 0.05]), flat[40:41] + np.float32([0, 0, 0.05])
    beside = behind + np.float32([0.2, 0, 0])
    points = np.concatenate([behind, flat, beside, before])
    skin = np.full((1, 3), -9, np.float32)
    for turn in (0.0, 0.1):
        eye = np.array([np.sin(turn), 0.0, np.cos(turn)])
        seen = unhidden(points, np.zeros_like(points), np.zeros(points.shape[:2], np.float32), skin, eye) // 8
        assert seen[0] == 83
        assert set(range(1, 84)) <= set(seen)
        assert (seen == 0).sum() <= 4  # the ends of the curtain hide nothing
    assert not len(unhidden(points[:0], points[:0], points[:0, :, 0], skin, eye))


def test_hair_shades_the_skin_next_to_it(grown):
    model, look, _, _ = grown
    shade = hair_shade(model, look)
    assert 0 <= shade.min() <= shade.max() <= 1
    behind = Hairline(model, look.hairline).over(model)
    face = (model.vertices[:, 2] > 0.02) & (behind < 0)
    assert shade[face & (behind > -0.004)].min() > 3 * shade[face & (behind < -0.02)].max()
    assert not hair_shade(model, look.model_copy(update={"style": "none"})).any()


@pytest.mark.slow
@settings(max_examples=20)
@given(st.tuples(*[st.floats(-0.2, 0.2)] * 3), st.floats(0, 0.03))
def test_points_pushed_out_of_the_hull_are_above_it(place, height):
    hull = Hull(load_model("amber"), ears=True)
    out = hull.push_out(np.array([place]), height)
    assert hull.height(out)[0] > height - 1e-6
    kept = hull.push_out(out, height)
    np.testing.assert_allclose(kept, out, atol=1e-9)


def test_the_hull_lies_on_the_head():
    model = load_model("onyx")
    heights = Hull(model, ears=True).height(model.vertices.astype(float))
    crown = model.vertices[:, 1] > model.landmarks["glabella"][1]
    assert np.abs(heights[crown]).max() < 0.006
