"""The jaw: what turns with it and how far, and the shape of the opening mouth."""

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from agentface.deform.finish import teeth, teeth_compiled
from agentface.deform.mouth import jaw
from agentface.deform.mouth import jaw_compiled as compiled
from agentface.deform.pipeline import GeometricDeformer
from agentface.parameters import FacePose
from agentface.studies.calibration.agreement import agreement
from tests.heads import deformer_of, head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
TABLES = {face: jaw.prepare(model) for face, model in FACES.items()}
LIP_RINGS = 8
OPENINGS = (0.25, 0.5, 0.75, 1.0)


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def opened(face, opening, points=None):
    result = (FACES[face].vertices if points is None else points).copy()
    jaw.apply(TABLES[face], FacePose.of(jaw_open=opening).array, result)
    return result


def drawn(face, opening):
    """``(V, 3)`` m: how far an opening draws the skin back, before it turns."""
    moves = np.zeros((len(FACES[face].vertices), 3))
    moves[TABLES[face].where, ::2] = opening * jaw.drawn_of(TABLES[face])
    return moves


def transform(face, opening):
    matrix = np.empty((4, 4), np.float32)
    teeth.apply(teeth.prepare(FACES[face]), FacePose.of(jaw_open=opening).array, matrix)
    return matrix


def turned(face, points, share, opening):
    """``points`` turned by the share of the opening, by complex numbers in the plane of y and z."""
    _, y, z = FACES[face].jaw.pivot
    turn = np.exp(1j * math.radians(FACES[face].jaw.widest_deg) * opening * share)
    plane = (points[:, 1] - y + 1j * (points[:, 2] - z)) * turn
    return np.stack([points[:, 0], plane.real + y, plane.imag + z], axis=1)


def test_a_closed_jaw_leaves_every_bit(face):
    np.testing.assert_array_equal(opened(face, 0.0), FACES[face].vertices)
    np.testing.assert_array_equal(transform(face, 0.0), np.eye(4))


def test_the_chin_is_as_rigid_as_the_lower_teeth(face):
    model = FACES[face]
    chin = np.linalg.norm(model.vertices - model.landmarks["pogonion"], axis=1) < 0.008
    assert chin.sum() >= 8
    moved, matrix = opened(face, 1.0)[chin], transform(face, 1.0)
    np.testing.assert_allclose(moved, model.vertices[chin] @ matrix[:3, :3].T + matrix[:3, 3], atol=1e-6)
    assert matrix[:3, :3] @ matrix[:3, :3].T == pytest.approx(np.eye(3), abs=1e-6)
    # the axis lies still
    axis = np.array([[x, *model.jaw.pivot[1:]] for x in (-0.05, 0.05)])
    np.testing.assert_allclose(axis @ matrix[:3, :3].T + matrix[:3, 3], axis, atol=1e-7)
    teeth = model.parts["teeth_lower"].attributes["POSITION"]
    lowered = teeth @ matrix[:3, :3].T + matrix[:3, 3]
    assert (lowered[:, 1] < teeth[:, 1] - 0.005).all(), "positive opens"


@pytest.mark.parametrize("opening", OPENINGS)
def test_the_lips_turn_by_the_papers_shares(face, opening):
    model = FACES[face]
    moved, start = opened(face, opening).astype(np.float64), FACES[face].vertices + drawn(face, opening)
    for ring in model.lips.rings[:LIP_RINGS]:
        corners, upper = [ring.upper[0], ring.upper[-1]], [ring.upper[len(ring.upper) // 2]]
        lower = [ring.lower[len(ring.lower) // 2]]
        for vertices, share in ((corners, 1 / 3), (upper, 0.0), (lower, 1.0)):
            expected = turned(face, start[vertices], share, opening)
            np.testing.assert_allclose(moved[vertices], expected, atol=3e-6)


def test_the_shares_go_smoothly_from_the_middle_of_a_lip_to_the_corner(face):
    share = FACES[face].jaw_weights
    for ring in FACES[face].lips.rings[:LIP_RINGS]:
        half = len(ring.lower) // 2
        steps = np.diff(share[ring.lower])
        assert (steps[:half] >= 0).all()
        assert (steps[half:] <= 0).all()
        assert np.abs(steps).max() < 0.2
        steps = np.diff(share[ring.upper])
        half = len(ring.upper) // 2
        assert (steps[:half] <= 0).all()
        assert (steps[half:] >= 0).all()
        assert np.abs(steps).max() < 0.07


def test_lids_brows_and_forehead_stay(face):
    share = FACES[face].jaw_weights
    for region in ("upper_face", "upper_eyelid", "lower_eyelid"):
        assert share[FACES[face].regions.mask([region])].max() < 0.02
    assert share.min() == 0.0
    assert share.max() == 1.0


def test_the_mouth_opens_to_an_oval(face):
    """The outline of the opening, seen from the front, is its own convex hull and as round at the corners."""
    model, deformer = FACES[face], deformer_of(face)
    ring = model.lips.rings[0]
    outline = [*ring.upper, *ring.lower[-2:0:-1]]
    for opening in OPENINGS[1:]:
        points = deformer.at(FacePose.of(jaw_open=opening)).vertices[outline, :2].astype(np.float64)
        x, y = points.T
        area = 0.5 * abs((x * np.roll(y, -1) - y * np.roll(x, -1)).sum())
        assert area > 0.96 * ConvexHull(points).volume
        # pi / 4 for an ellipse, 1 / 2 for a rhombus, 1 for a box
        assert 0.66 < area / (np.ptp(x) * np.ptp(y)) < 0.85


@pytest.mark.parametrize("opening", OPENINGS)
def test_no_skin_is_torn(face, opening):
    model = FACES[face]
    ends = np.concatenate([model.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    lips = model.material[:, 0] > 0.05
    moved = opened(face, opening)
    stretch = np.linalg.norm(moved[ends[:, 0]] - moved[ends[:, 1]], axis=1)
    stretch /= np.linalg.norm(model.vertices[ends[:, 0]] - model.vertices[ends[:, 1]], axis=1)
    assert stretch[~lips[ends].any(axis=1)].max() < 3.0
    # at the corners the lips open: what was one line becomes the side of the oval
    assert stretch.max() < 9.0


def test_the_jaw_agrees_with_the_artists(face):
    model = FACES[face]
    moved = deformer_of(face).at(FacePose.of(jaw_open=1.0)).vertices - model.vertices
    row = agreement(model, moved, model.shapes["jawOpen"].dense(len(moved)))
    assert row.cosine > 0.95
    assert 0.95 < row.peak_ratio < 1.05


def test_points_between_vertices_follow_their_mean(face):
    model = FACES[face]
    draw = np.random.default_rng(3)
    vertices = draw.integers(0, len(model.vertices), (40, 4)).astype(np.int32)
    weights = draw.dirichlet(np.ones(4), 40).astype(np.float32)
    tables = jaw.prepare(model, (vertices, weights))
    rest = np.concatenate([model.vertices, draw.normal(size=(40, 3)).astype(np.float32) * 0.1])
    moved = rest.copy()
    jaw.apply(tables, FacePose.of(jaw_open=0.8).array, moved)
    np.testing.assert_array_equal(moved[:-40], opened(face, 0.8))
    share = (model.jaw_weights[vertices] * weights).sum(axis=1)
    start = rest[-40:] + (drawn(face, 0.8)[vertices] * weights[..., None]).sum(axis=1)
    np.testing.assert_allclose(moved[-40:], turned(face, start, share, 0.8), atol=1e-6)


@given(st.floats(0, 1, width=32))
def test_compiled_and_plain_are_the_same(opening):
    values = FacePose.of(jaw_open=opening).array
    for face, model in FACES.items():
        plain, fast = model.vertices.copy(), model.vertices.copy()
        jaw.apply(TABLES[face], values, plain)
        compiled.apply(TABLES[face], values, fast)
        np.testing.assert_allclose(fast, plain, atol=1e-7, rtol=0)
        one, other = np.empty((4, 4), np.float32), np.empty((4, 4), np.float32)
        teeth.apply(teeth.prepare(model), values, one)
        teeth_compiled.apply(teeth.prepare(model), values, other)
        np.testing.assert_allclose(other, one, atol=1e-7, rtol=0)


def test_the_lips_on_the_screen_turn_by_the_papers_shares(face, monkeypatch):
    """After the lips' surface, and not only the shares that the mesh has; the turn alone, with nothing drawn back."""
    monkeypatch.setattr(jaw, "_TAUT", 0.0)
    model = replace(FACES[face])  # another one, whose tables are made anew
    deformer = GeometricDeformer(model, compiled=False)
    geometry = deformer.at(FacePose())
    stages = deformer.stages(geometry)
    _, y, z = model.jaw.pivot
    for opening in OPENINGS:
        for name in ("muscles", "jaw", "lips", "copy"):
            stages[name](FacePose.of(jaw_open=opening))
        before, after = (p[:, 1] - y + 1j * (p[:, 2] - z) for p in (model.vertices, geometry.vertices))
        share = np.angle(after / before) / (opening * math.radians(model.jaw.widest_deg))
        for ring in model.lips.rings[:LIP_RINGS]:
            np.testing.assert_allclose(share[[ring.upper[0], ring.upper[-1]]], 1 / 3, atol=0.01)
            assert share[ring.upper[len(ring.upper) // 2]] == pytest.approx(0, abs=0.015)
            assert share[ring.lower[len(ring.lower) // 2]] == pytest.approx(1, abs=0.015)
