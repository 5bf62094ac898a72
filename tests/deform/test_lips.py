"""The lips' B-spline surface and orbicularis oris: what a surface must keep, and what the muscle must do."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from agentface.deform.mouth import lips
from agentface.deform.mouth import lips_compiled as compiled
from agentface.deform.mouth.lip_grid import VERMILION_RING, lip_grid
from agentface.deform.mouth.lip_mesh import evaluate, patch_mesh
from agentface.deform.mouth.lip_surface import COLUMNS, ROWS, grid_places, mirrored_controls, weights
from agentface.errors import InvalidValueError
from agentface.mesh import bspline
from agentface.parameters import FacePose
from tests.heads import head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
TABLES = {face: lips.prepare(model) for face, model in FACES.items()}
MM = 1e-3


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def at_rest(face):
    return np.concatenate([FACES[face].vertices, TABLES[face].control_rest])


def contracted(face, module=lips, **contractions):
    points = at_rest(face)
    module.contract(TABLES[face], FacePose.of(**contractions).array, lips.as_they_lie(TABLES[face], points), points)
    module.surface(TABLES[face], points)
    return points


def moved_far(face, seed, size):
    rng = np.random.default_rng(seed)
    points = at_rest(face)
    return (points + size * rng.standard_normal(points.shape)).astype(np.float32)


def surface_at(face, across, along, control):
    index, weight = weights(np.array([across]), np.array([along]))
    return (weight[..., None] * control[index]).sum(1)[0]


@given(st.floats(0, 24, exclude_max=True), st.floats(0, 1))
def test_the_weights_of_a_point_are_a_partition_of_one(across, along):
    index, weight = weights(np.array([across]), np.array([along]))
    assert weight.min() >= -1e-12
    assert weight.sum() == pytest.approx(1.0, abs=1e-12)
    assert len(set(index.ravel().tolist())) == 16


@given(st.floats(0, 1), st.integers(0, 3))
def test_the_clamped_curve_agrees_with_scipy(along, which):
    from scipy.interpolate import BSpline

    knots = [0, 0, 0, 0, 1 / 3, 2 / 3, 1, 1, 1, 1]
    column, weight = bspline.clamped(np.array([along]), ROWS)
    control = np.random.default_rng(which).standard_normal(ROWS)
    assert (weight[0] * control[column[0]]).sum() == pytest.approx(float(BSpline(knots, control, 3)(along)), abs=1e-12)


@given(st.floats(0, 23.99))
def test_the_closed_curve_agrees_with_scipy(across):
    from scipy.interpolate import BSpline

    control = np.random.default_rng(4).standard_normal(COLUMNS)
    wrapped = np.concatenate([control[-1:], control, control[:3]])
    column, weight = bspline.closed(np.array([across]), COLUMNS)
    expected = float(BSpline(np.arange(-3.0, len(wrapped) + 1), wrapped, 3)(across))
    assert (weight[0] * control[column[0]]).sum() == pytest.approx(expected, abs=1e-12)


def test_the_surface_passes_near_the_lips_at_rest(face):
    tables = TABLES[face]
    places = np.meshgrid(tables.across.astype(np.float64), tables.along.astype(np.float64))
    controls, weight = weights(*places)
    there = (weight[..., None] * tables.control_rest[controls]).sum(-2)
    miss = np.linalg.norm(there - tables.rest.reshape(there.shape), axis=2)
    assert np.sqrt((miss**2).mean()) < 0.6 * MM
    assert miss[1:].max() < 2.5 * MM, "but for the innermost ring, which nobody sees"


def test_the_grid_closes_round_the_mouth_from_its_inside_to_the_skin(face):
    model, tables = FACES[face], TABLES[face]
    grid = lip_grid(model)
    assert len(np.unique(grid.vertices)) == grid.vertices.size
    np.testing.assert_array_equal(model.mirror[grid.vertices], grid.vertices[:, grid.mirror])
    assert set(model.lips.rings[7].upper) <= set(grid.vertices[VERMILION_RING].tolist())
    assert model.material[grid.vertices[0], 0].min() > 0.3
    assert model.material[grid.vertices[-1], :2].max() == 0.0
    across, along = grid_places(grid, model.vertices.astype(np.float64))
    np.testing.assert_allclose((COLUMNS / 2 - across) % COLUMNS, across[grid.mirror], atol=1e-9)
    assert (np.diff(along) > 0).all()
    np.testing.assert_allclose(tables.control_weights.sum(1), 1.0, atol=1e-6)
    control = tables.control_rest.reshape(COLUMNS, ROWS, 3)
    assert np.abs(control[[6, 18], :, 0]).max() < 1e-6
    assert control[0, :, 0].min() > 0 > control[12, :, 0].max()


@settings(max_examples=20)
@given(hnp.arrays(np.float64, 6, elements=st.floats(-1, 1)))
def test_the_patch_takes_every_rigid_motion_of_its_control_points(numbers):
    for face, tables in TABLES.items():
        turn, _ = np.linalg.qr(np.eye(3) + np.cross(np.eye(3), numbers[:3]))
        points = at_rest(face)
        before = points.copy()
        moved = before[tables.skin_count :] @ turn.T + 0.02 * numbers[3:]
        points[tables.skin_count :] = moved
        lips.surface(tables, points)
        inside = tables.blend == 1.0
        # the surface turns rigidly; the mesh's own detail on it, which is the fit's residual, only goes along
        there = (tables.weight[..., None].astype(np.float64) * before[tables.skin_count :][tables.controls]).sum(1)
        expected = there @ turn.T + 0.02 * numbers[3:] + (tables.rest - there)
        np.testing.assert_allclose(points[tables.patch][inside], expected[inside], atol=1e-6)


def test_nothing_contracted_moves_nothing(face):
    for module in (lips, compiled):
        np.testing.assert_array_equal(contracted(face, module), at_rest(face))


@pytest.mark.parametrize("muscle", ["orbicularis_oris_pucker", "orbicularis_oris_press"])
def test_the_lips_go_over_into_the_skin_without_a_seam(face, muscle):
    """No edge at the patch's outer ring is strained more than the lips themselves are, on either side of it."""
    moved = contracted(face, **{muscle: 1.0})
    model, grid = FACES[face], lip_grid(FACES[face])
    shift = (moved - at_rest(face))[: len(model.vertices)]
    pairs = np.unique(
        np.sort(np.concatenate([model.triangles[:, [a, b]] for a, b in ((0, 1), (1, 2), (2, 0))])), axis=0
    )
    strain = np.linalg.norm(shift[pairs[:, 0]] - shift[pairs[:, 1]], axis=1)
    strain /= np.linalg.norm(model.vertices[pairs[:, 0]] - model.vertices[pairs[:, 1]], axis=1)
    rings = np.full(len(model.vertices), 99)
    for number, ring in enumerate(grid.vertices):
        rings[ring] = number
    last = len(grid.vertices) - 1
    inside = (rings[pairs] < last).all(1)
    at_edge = (rings[pairs] >= last - 1).all(1) & (rings[pairs] <= last).any(1) & (rings[pairs] >= last).any(1)
    assert at_edge.sum() > 100
    assert strain[at_edge].max() < 1.25 * strain[inside].max()
    assert strain[at_edge].max() < 0.9


def test_skin_far_from_the_mouth_stays(face):
    model = FACES[face]
    shift = np.linalg.norm(contracted(face, orbicularis_oris_pucker=1.0) - at_rest(face), axis=1)[: len(model.vertices)]
    lid = [vertex for ring in model.eyelids.rings["l"] for vertex in ring.upper + ring.lower]
    assert shift[lid].max() == 0.0
    assert shift[np.abs(model.vertices - model.landmarks["nose_tip"]).sum(1).argmin()] < 0.5 * MM


def test_a_pucker_draws_the_mouth_together_and_forward(face):
    model, rest = FACES[face], at_rest(face)
    moved = contracted(face, orbicularis_oris_pucker=1.0)
    rings = model.lips.rings
    corner, seam = rings[0].upper[0], rings[1].upper
    middles = [half[len(half) // 2] for half in (rings[4].upper, rings[4].lower)]
    assert 0.6 < moved[corner, 0] / rest[corner, 0] < 0.85
    assert (moved[middles, 2] - rest[middles, 2]).min() > 5 * MM
    border = rings[7].upper[len(rings[7].upper) // 2]
    profile = [point[border, 1:] - point[seam[len(seam) // 2], 1:] for point in (rest, moved)]
    leaning = [np.arctan2(y, z) for y, z in profile]
    assert leaning[1] - leaning[0] > np.radians(4)  # the upper lip turns outward


def test_a_press_hides_the_red_of_the_lips(face):
    rest, rings = at_rest(face), FACES[face].lips.rings
    heights = []
    for level in (0.0, 0.5, 1.0):
        moved = contracted(face, orbicularis_oris_press=level) if level else rest
        upper, lower = (half[len(half) // 2] for half in (rings[7].upper, rings[7].lower))
        heights.append(moved[upper, 1] - moved[lower, 1])
    assert heights[0] > heights[1] > 0.8 * heights[0]
    assert heights[2] < 0.72 * heights[0]


def test_the_press_rolls_the_lips_in_only_when_strong(face):
    tables = TABLES[face]
    levels = [lips.contraction_levels(tables, FacePose.of(orbicularis_oris_press=v).array) for v in (0, 0.4, 0.7, 1)]
    np.testing.assert_allclose([level[2] for level in levels], [0, 0, 0.25, 1], atol=1e-6)


@given(st.floats(0, 1, width=32), st.floats(0, 1, width=32))
def test_the_parts_of_a_contraction_are_those_of_steps_of_a_fifth(pucker, press):
    pose = FacePose.of(orbicularis_oris_pucker=pucker, orbicularis_oris_press=press).array
    both = np.full((2, 6, lips.CONTRACTIONS), np.nan, np.float32)
    for module, shares in zip((lips, compiled), both, strict=True):
        module.slice_steps(TABLES["amber"], pose, 0.2, shares)
        np.testing.assert_allclose(shares.sum(axis=0), 1.0, atol=1e-5)
        assert not shares[-1].any()
        assert shares.min() >= -1e-6
        if pucker > 1e-3:
            expected = [max(0.0, min(0.2, pucker - 0.2 * step)) / pucker for step in range(5)]
            np.testing.assert_allclose(shares[:5, 0], expected, atol=1e-4)
        if press > TABLES["amber"].roll_from + 1e-3:
            assert np.abs(shares[:2, 2]).max() < 1e-6, "the first two steps press and do not roll"
    np.testing.assert_allclose(*both, atol=1e-4)


@settings(max_examples=20)
@given(st.floats(0, 1), st.floats(0, 1), st.floats(-0.01, 0.01))
def test_lips_found_further_out_are_drawn_in_from_there(pucker, press, aside):
    pose = FacePose.of(orbicularis_oris_pucker=pucker, orbicularis_oris_press=press).array
    for face, tables in TABLES.items():
        points = [at_rest(face), at_rest(face)]
        found = lips.as_they_lie(tables, points[0])
        lips.contract(tables, pose, found, points[0])
        lips.contract(tables, pose, found + np.float32(aside), points[1])
        levels = lips.contraction_levels(tables, pose)
        gap = (points[1] - points[0])[tables.skin_count :]
        np.testing.assert_allclose(gap[:, 0], -aside * (levels[:, None] * tables.pull).sum(0), atol=1e-6)
        assert not gap[:, 1:].any()


@pytest.mark.parametrize(
    ("muscle", "shapes", "least"),
    [
        ("orbicularis_oris_pucker", ["mouthPucker"], 0.9),
        ("orbicularis_oris_press", ["mouthRollUpper", "mouthRollLower"], 0.75),
    ],
)
def test_the_muscle_agrees_with_the_artists(face, muscle, shapes, least):
    from agentface.studies.calibration.agreement import agreement

    model = FACES[face]
    artists = sum((model.shapes[name].dense(len(model.vertices)) for name in shapes), 0 * model.vertices)
    shift = (contracted(face, **{muscle: 1.0}) - at_rest(face))[: len(model.vertices)]
    result = agreement(model, shift, artists)
    assert result.cosine > least
    assert 0.7 <= result.peak_ratio <= 1.4


@settings(max_examples=30)
@given(st.floats(0, 1), st.floats(0, 1), st.integers(0, 10**6))
def test_compiled_and_numpy_agree(pucker, press, seed):
    pose = FacePose.of(orbicularis_oris_pucker=pucker, orbicularis_oris_press=press).array
    for face, tables in TABLES.items():
        one = moved_far(face, seed, 0.004)
        other = one.copy()
        for module, points in ((lips, one), (compiled, other)):
            module.contract(tables, pose, lips.as_they_lie(tables, points), points)
            module.surface(tables, points)
        np.testing.assert_allclose(one, other, atol=1e-7)
        assert np.isfinite(one).all()


@settings(max_examples=10)
@given(st.floats(0, 1), st.floats(0, 1))
def test_the_lips_are_symmetric(pucker, press):
    for face, model in FACES.items():
        points = contracted(face, orbicularis_oris_pucker=pucker, orbicularis_oris_press=press)
        count, flip = len(model.vertices), np.array([-1, 1, 1])
        np.testing.assert_allclose(points[:count][model.mirror] * flip, points[:count], atol=1e-5)
        np.testing.assert_allclose(points[count:][mirrored_controls()] * flip, points[count:], atol=1e-5)


def test_a_little_more_contraction_moves_little_more(face):
    levels = np.linspace(0, 1, 41)
    for muscle in ("orbicularis_oris_pucker", "orbicularis_oris_press"):
        frames = np.stack([contracted(face, **{muscle: float(level)}) for level in levels])
        assert np.linalg.norm(np.diff(frames, axis=0), axis=2).max() < 1 * MM


@pytest.mark.parametrize("per_cell", [1, 3])
def test_the_fine_lips_pass_through_the_patch(face, per_cell):
    tables = TABLES[face]
    fine = patch_mesh(tables, per_cell)
    for points in (at_rest(face), contracted(face, orbicularis_oris_pucker=1.0)):
        places, normals = evaluate(tables, fine, points)
        coarse = places.reshape(fine.rings, fine.columns, 3)[::per_cell, ::per_cell].reshape(-1, 3)
        np.testing.assert_allclose(coarse, points[tables.patch], atol=1e-6)
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-5)
        a, b, c = (places[fine.triangles[:, corner]] for corner in range(3))
        faces = np.cross(b - a, c - a)
        assert ((faces * normals[fine.triangles].mean(1)).sum(1) > 0).mean() > 0.998


@settings(max_examples=10)
@given(hnp.arrays(np.float64, 6, elements=st.floats(-1, 1)))
def test_the_fine_lips_go_along_with_every_shift(numbers):
    for face, tables in TABLES.items():
        fine = patch_mesh(tables, 2)
        points = contracted(face, orbicularis_oris_pucker=0.6)
        shift = (0.02 * numbers[:3]).astype(np.float32)
        one, other = (evaluate(tables, fine, placed)[0] for placed in (points, points + shift))
        np.testing.assert_allclose(other, one + shift, atol=1e-6)


def test_between_the_vertices_the_fine_lips_follow_the_surface(face):
    """Where the patch moves as the surface says, so do the fine vertices, and not merely between their neighbours."""
    tables = TABLES[face]
    fine = patch_mesh(tables, 4)
    points = at_rest(face)
    bump = np.random.default_rng(0).standard_normal((COLUMNS * ROWS, 3)).astype(np.float32) * MM
    points[tables.skin_count :] += bump
    points[tables.patch] += (tables.weight[..., None] * bump[tables.controls]).sum(1)
    moved = evaluate(tables, fine, points)[0] - evaluate(tables, fine, at_rest(face))[0]
    free = fine.free == 1.0
    expected = (fine.weight[..., None] * bump[fine.controls]).sum(1)
    np.testing.assert_allclose(moved[free], expected[free], atol=1e-6)


def test_how_fine_is_a_whole_number(face):
    for per_cell in (0, 65):
        with pytest.raises(InvalidValueError, match="per_cell"):
            patch_mesh(TABLES[face], per_cell)
