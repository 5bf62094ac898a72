"""Long hair as sheets: where they lie, and that they hide the scalp and not the face."""

import numpy as np
import pytest

from agentface.head.look import load_look
from agentface.view.hair.hairline import Hairline
from agentface.view.hair.hull import Hull
from agentface.view.hair.sheets import edge_shade, flyaways, parting_line, sheets
from agentface.view.hair.styles import PARTED, Amount
from tests.heads import head_model


@pytest.fixture(scope="module")
def grown():
    model = head_model("amber")
    look = load_look(model).hair
    assert look.style in PARTED
    return model, look, sheets(model, look, Hull(model, ears=True), np.random.default_rng(2))


def test_the_same_generator_gives_the_same_sheets(grown):
    model, look, first = grown
    for one, other in zip(first, sheets(model, look, Hull(model, ears=True), np.random.default_rng(2)), strict=True):
        np.testing.assert_array_equal(one.points, other.points)
        np.testing.assert_array_equal(one.places, other.places)


def test_each_side_has_its_own_and_they_meet_at_the_parting(grown):
    model, look, found = grown
    line = parting_line(model, look, Hull(model, ears=True))
    assert len(found) == 4
    sides = [np.sign((sheet.points[:20, 5, 0] - line[:, 0].mean()).mean()) for sheet in found[:2]]
    assert sorted(sides) == [-1.0, 1.0]
    for sheet in found[:2]:
        first = sheet.points[0, 0]
        assert np.linalg.norm(line - first, axis=1).min() < 0.008


def test_they_lie_over_the_skin_and_leave_the_face_free(grown):
    model, _, found = grown
    at, unit = model.landmarks, model.landmarks.eye_separation
    for sheet in found:
        points = sheet.points.reshape(-1, 3)
        inner = np.linalg.norm(model.vertices - sheet.centre, axis=1)
        for point in points[::17]:
            nearest = np.linalg.norm(model.vertices - point, axis=1).argmin()
            if model.vertices[nearest, 1] > at["pupil_l"][1]:
                assert np.linalg.norm(point - sheet.centre) > inner[nearest] - 0.004
        face = (np.abs(points[:, 0]) < at["brow_outer_l"][0]) & (points[:, 1] < at["brow_middle_l"][1])
        assert not (face & (points[:, 2] > 0.5 * unit)).any()


def test_they_fall_as_long_as_the_look_says(grown):
    model, look, found = grown
    lowest = min(sheet.points[..., 1].min() for sheet in found)
    assert lowest == pytest.approx(look.length * model.landmarks["menton"][1], abs=0.02)
    short = sheets(
        model, look.model_copy(update={"length": 0.5 * look.length}), Hull(model, ears=True), np.random.default_rng(2)
    )
    assert min(sheet.points[..., 1].min() for sheet in short) > lowest + 0.02


def test_a_sheets_triangles_face_outward_and_its_places_are_parts(grown):
    for sheet in grown[2]:
        rows, triangles = sheet.mesh()
        a, b, c = (rows[triangles[:, corner], :3].astype(np.float64) for corner in range(3))
        across = np.cross(b - a, c - a)
        assert ((across * rows[triangles, 6:9].sum(axis=1)).sum(axis=1) > 0.0).all()
        np.testing.assert_allclose(np.linalg.norm(rows[:, 6:9], axis=1), 1.0, atol=1e-5)
        assert 0.0 <= sheet.places[..., 1].min() < sheet.places[..., 1].max() <= 1.0
        assert (np.diff(sheet.places[..., 0], axis=0) > 0).all()


def test_single_hairs_leave_the_outer_sheets_and_stay_near(grown):
    model, look, found = grown
    hairs = flyaways(
        found, Amount(locks=0, width=0.001, hairs=60, radius=1e-4, points=8), look, np.random.default_rng(1)
    )
    assert hairs.points.shape == (60, 8, 3)
    outer = np.concatenate([sheet.points.reshape(-1, 3) for sheet in found[:2]])
    away = [np.linalg.norm(outer - point, axis=1).min() for point in hairs.points.reshape(-1, 3)[::7]]
    assert max(away) < 0.02
    behind = Hairline(model, look.hairline).behind(hairs.points[:, 0])
    assert np.median(behind) > 0.0


def test_hair_at_the_face_shades_the_skin_beside_it_and_not_the_middle_of_the_face(grown):
    model, _, found = grown
    shade = edge_shade(found, model.vertices)
    assert shade.max() > 0.4
    for name in ("nose_tip", "glabella", "menton", "mouth_corner_l"):
        assert shade[np.linalg.norm(model.vertices - model.landmarks[name], axis=1).argmin()] < 0.01, name
    assert not edge_shade([], model.vertices).any()
