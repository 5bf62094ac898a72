"""The ruler against what is known by other ways: triangles, the jaw's turn, the rest."""

import math

import numpy as np
import pytest

from agentface.parameters import FacePose
from agentface.speech.visemes import viseme_table
from agentface.studies.mouth_ruler import MouthRuler
from tests.heads import deformer_of, head_model

FACES = ("amber", "onyx")
RULERS = {face: MouthRuler(head_model(face)) for face in FACES}


@pytest.fixture(params=FACES)
def face(request):
    return request.param


def measured(face, bite=False, **pose):
    return RULERS[face].measure(deformer_of(face).at(FacePose.of(**pose)), bite=bite)


def test_a_face_at_rest_is_where_all_is_counted_from(face):
    rest = measured(face)
    assert (rest.width, rest.protrusion, rest.jaw) == (0.0, 0.0, 0.0)
    assert 0.0 <= rest.gap < 0.3
    assert math.isnan(rest.bite)


def test_the_jaw_is_where_its_turn_takes_the_incisors(face):
    model = head_model(face)
    turn = 0.3 * math.radians(model.jaw.widest_deg)
    forward = model.landmarks["lower_lip_middle"][2] - model.jaw.pivot[2]
    assert measured(face, jaw_open=0.3).jaw == pytest.approx(1e3 * forward * math.sin(turn), rel=0.25)


def test_the_gap_is_what_a_ray_through_the_mouth_meets(face):
    """Down the middle from lip to lip, by the heights of the columns next to it."""
    ruler, geometry = RULERS[face], deformer_of(face).at(FacePose.of(jaw_open=0.4))
    table = ruler._contact
    rings = table.grid[table.first : table.last + 1]
    heights = [geometry.vertices[rings[:, columns], :2] for columns in (table.upper, table.lower)]
    clear = []
    for x in np.linspace(-0.008, 0.008, 33):
        lines = [[np.interp(-x, -ring[:, 0], ring[:, 1]) for ring in lip] for lip in heights]
        clear.append(min(lines[0]) - max(lines[1]))
    assert ruler.measure(geometry).gap == pytest.approx(1e3 * max(clear), abs=0.3)


def test_the_bite_is_the_distance_of_points_from_triangles(face):
    model, geometry = head_model(face), deformer_of(face).at(FacePose.of(jaw_open=0.1))
    ruler = RULERS[face]
    mesh = model.parts["teeth_upper"]
    lips = geometry.vertices[ruler._inner].reshape(-1, 3)
    lips = lips[np.abs(lips[:, 0]) < 0.013]
    corners = mesh.attributes["POSITION"][mesh.attributes["_MATERIAL"][:, 0] > 0]
    to_corners = np.linalg.norm(lips[:, None] - corners[None], axis=2).min()
    found = ruler.measure(geometry, bite=True).bite
    assert found <= 1e3 * to_corners + 1e-6
    assert found > 1e3 * to_corners - 1.6


def test_a_moved_mouth_is_measured_where_it_is(face):
    """A smile widens, a pucker narrows and protrudes, a raised lip bares teeth, and a shift changes none of them."""
    assert measured(face, zygomaticus_major=1.0).width > 5.0
    pucker = measured(face, orbicularis_oris_pucker=1.0)
    assert pucker.width < -5.0
    assert pucker.protrusion > 3.0
    assert measured(face, levator_labii_superioris=0.8).teeth > measured(face).teeth + 1.0
    aside, ahead = measured(face, jaw_open=0.3, mouth_shift=0.5), measured(face, jaw_open=0.3)
    assert aside.gap == pytest.approx(ahead.gap, rel=0.15)


def test_visemes_do_what_phonetics_asks_on_both_faces(face):
    shown = {
        name: RULERS[face].measure(deformer_of(face).at(FacePose(each.values)), bite=True)
        for name, each in viseme_table().items()
    }
    assert shown["PP"].gap <= 0.1
    assert shown["FF"].bite <= 0.5
    assert shown["FF"].teeth > 3.5
    assert shown["SS"].jaw <= 1.5
    assert shown["CH"].jaw <= 1.5
    assert 10.0 < shown["aa"].jaw == max(each.jaw for each in shown.values())
    assert shown["aa"].gap > shown["oh"].gap > shown["E"].gap > shown["ih"].gap > shown["iy"].gap > shown["ou"].gap
    assert shown["iy"].width == max(each.width for each in shown.values()) > 4.5
    assert shown["ou"].width == min(each.width for each in shown.values()) < -9.0
    for name in ("ou", "oh", "CH", "RR"):
        assert shown[name].protrusion > 2.0
    for name in ("DD", "kk", "nn", "ih", "E", "aa"):
        assert abs(shown[name].protrusion) < 0.6
