"""Long hair as cards over sheets: where they lie, and that they hide the scalp and not the face."""

import numpy as np
import pytest

from agentface.head.look import load_look
from agentface.view.hair.cards import cards
from agentface.view.hair.drape import parting_line
from agentface.view.hair.flyaways import baby_hairs, flyaways
from agentface.view.hair.hairline import Hairline
from agentface.view.hair.hull import Hull
from agentface.view.hair.sheets import FIRST_CARD, PAINTED, edge_shade, sheet_places, sheets, sheets_mesh
from agentface.view.hair.styles import PARTED, Amount, parting_of
from tests.heads import head_model


@pytest.fixture(scope="module")
def grown():
    model = head_model("amber")
    look = load_look(model).hair
    assert look.style in PARTED
    return model, look, grow(model, look)


def grow(model, look):
    hull, rng = Hull(model, ears=True), np.random.default_rng(2)
    return cards(model, look, hull, rng), sheets(model, look, hull, rng)


def test_the_same_generator_gives_the_same_sheets(grown):
    model, look, (first, beneath) = grown
    again, below = grow(model, look)
    for one, other in zip(first + beneath, again + below, strict=True):
        np.testing.assert_array_equal(one.points, other.points)
        np.testing.assert_array_equal(one.places, other.places)


def test_each_side_has_its_own_and_they_meet_at_the_parting(grown):
    model, look, (over, beneath) = grown
    line = parting_line(model, look, Hull(model, ears=True))
    assert len(beneath) == 2
    assert len(over) > 50
    sides = [np.sign((sheet.points[:10, 5, 0] - line[:, 0].mean()).mean()) for sheet in beneath]
    assert sorted(sides) == [-1.0, 1.0]
    for sheet in beneath:
        first = sheet.points[0, 0]
        assert np.linalg.norm(line - first, axis=1).min() < 0.008


def test_they_lie_over_the_skin_and_leave_the_face_free(grown):
    model, _, (over, beneath) = grown
    at, unit = model.landmarks, model.landmarks.eye_separation
    for sheet in over + beneath:
        points = sheet.points.reshape(-1, 3)
        inner = np.linalg.norm(model.vertices - sheet.centre, axis=1)
        for point in points[::17]:
            nearest = np.linalg.norm(model.vertices - point, axis=1).argmin()
            if model.vertices[nearest, 1] > at["pupil_l"][1]:
                assert np.linalg.norm(point - sheet.centre) > inner[nearest] - 0.004
        # it frames the cheeks below the mouth, and nothing above that
        low = points[:, 1] < at["mouth_corner_l"][1]
        free = np.where(low, at["mouth_corner_l"][0], at["brow_outer_l"][0])
        face = (np.abs(points[:, 0]) < free) & (points[:, 1] < at["brow_middle_l"][1])
        assert not (face & (points[:, 2] > 0.5 * unit)).any()


def test_they_fall_as_long_as_the_look_says(grown):
    model, look, (over, _) = grown
    lowest = min(sheet.points[..., 1].min() for sheet in over)
    assert lowest == pytest.approx(look.length * model.landmarks["menton"][1], abs=0.02)
    short, _ = grow(model, look.model_copy(update={"length": 0.5 * look.length}))
    assert min(sheet.points[..., 1].min() for sheet in short) > lowest + 0.02


def test_a_sheets_triangles_face_outward_and_its_places_are_parts(grown):
    over, beneath = grown[2]
    for sheet in over + beneath:
        rows, triangles = sheet.mesh()
        a, b, c = (rows[triangles[:, corner], :3].astype(np.float64) for corner in range(3))
        across = np.cross(b - a, c - a)
        assert ((across * rows[triangles, 6:9].sum(axis=1)).sum(axis=1) > 0.0).all()
        np.testing.assert_allclose(np.linalg.norm(rows[:, 6:9], axis=1), 1.0, atol=1e-5)
        assert 0.0 <= sheet.places[..., 1].min() < sheet.places[..., 1].max() <= 1.0
        assert (np.diff(sheet.places[..., 0], axis=0) > 0).all()


def test_cards_lie_in_one_order_over_the_sheets_and_end_unequally(grown):
    model, _, (over, beneath) = grown
    hull = Hull(model, ears=True)
    heights = np.array([hull.height(card.points[:, 4].astype(float)).mean() for card in over])
    light = np.array([card.places[..., 2].max() for card in over])
    middle = slice(len(over) // 4, len(over) // 2)  # behind the face, where all are as thick
    assert np.corrcoef(heights[middle], light[middle])[0, 1] > 0.6
    assert heights[middle].min() > max(hull.height(sheet.points[12:, 4].astype(float)).mean() for sheet in beneath)
    assert np.ptp([card.points[..., 1].min() for card in over]) > 0.02
    assert max(sheet.places[..., 2].max() for sheet in beneath) < light.min()


def test_places_of_cards_and_sheets_have_their_own_texture_coordinates(grown):
    over, beneath = (sheet_places(sheets_mesh(layer).fields["sheet"]) for layer in grown[2])
    assert 0.0 <= beneath[:, 0].min() < beneath[:, 0].max() < FIRST_CARD / PAINTED
    assert FIRST_CARD / PAINTED < over[:, 0].min() < over[:, 0].max() < 1.0


def test_single_hairs_leave_the_cards_and_short_ones_stand_at_the_hairline(grown):
    model, look, (over, _) = grown
    amount = Amount(locks=0, width=0.001, hairs=60, radius=1e-4, points=8)
    hairs = flyaways(over, amount, look, np.random.default_rng(1))
    assert hairs.points.shape == (60, 8, 3)
    outer = np.concatenate([sheet.points.reshape(-1, 3) for sheet in over])
    away = [np.linalg.norm(outer - point, axis=1).min() for point in hairs.points.reshape(-1, 3)[::7]]
    assert max(away) < 0.02
    line = Hairline(model, look.hairline)
    assert np.median(line.behind(hairs.points[:, 0])) > 0.0
    short = baby_hairs(model, amount, look, parting_of(model, look), np.random.default_rng(1))
    assert len(short.points) > 10
    assert np.abs(line.behind(short.points[:, 0])).max() < 0.02
    assert np.linalg.norm(short.points[:, -1] - short.points[:, 0], axis=1).max() < 0.02


def test_hair_at_the_face_shades_the_skin_beside_it_and_not_the_middle_of_the_face(grown):
    model, _, (_, beneath) = grown
    shade = edge_shade(beneath, model.vertices)
    assert shade.max() > 0.4
    for name in ("nose_tip", "glabella", "menton", "mouth_corner_l"):
        assert shade[np.linalg.norm(model.vertices - model.landmarks[name], axis=1).argmin()] < 0.01, name
    assert not edge_shade([], model.vertices).any()
