"""Every tooth knows its own sides, edge and gum."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.resources import face_names
from agentface.view.parts.shirt import shirt
from agentface.view.parts.teeth import crown_places, meeting_places, tones
from tests.heads import head_model


def row_of(face, row):
    """The places of a row's vertices, its triangles, and how far each vertex is of a tooth."""
    mesh = head_model(face).parts[row]
    return mesh.attributes["POSITION"], mesh.triangles, mesh.attributes["_MATERIAL"][:, 0] / 255.0


@pytest.mark.parametrize("face", face_names())
@pytest.mark.parametrize("row", ["teeth_upper", "teeth_lower"])
def test_each_of_fourteen_teeth_spans_its_own_width_and_height(face, row):
    positions, triangles, tooth = row_of(face, row)
    places = crown_places(positions, triangles, tooth)
    assert (places[tooth < 0.5] == 0).all()
    assert np.abs(places[:, 0]).max() <= 1
    assert 0 <= places[:, 1].min() <= places[:, 1].max() <= 1
    crown = tooth > 0.5
    # one vertex of each tooth is farthest aside
    assert (np.abs(places[crown, 0]) == 1).sum() >= 14
    edge, neck = crown & (places[:, 1] < 0.05), crown & (places[:, 1] > 0.95)
    above = positions[neck, 1].mean() - positions[edge, 1].mean()
    assert (above > 0) == (row == "teeth_upper")
    # the sides of a front tooth lie across, those of a back tooth along the jaw
    front = crown & (np.abs(positions[:, 0]) < 0.004)
    assert np.corrcoef(places[front, 0], np.sign(places[front, 0]))[0, 1] > 0.5
    assert places[front, 0].min() < -0.9
    assert places[front, 0].max() > 0.9


@pytest.mark.parametrize("face", face_names())
@pytest.mark.parametrize("row", ["teeth_upper", "teeth_lower"])
def test_incisors_meet_in_the_middle_of_the_face(face, row):
    positions, triangles, tooth = row_of(face, row)
    met = meeting_places(positions, triangles, tooth)
    own = crown_places(positions, triangles, tooth)
    np.testing.assert_array_equal(met[:, 1], own[:, 1])
    front = (tooth > 0.5) & (positions[:, 2] > positions[tooth > 0.5, 2].max() - 0.004)
    at_middle, clear = np.abs(positions[:, 0]) < 0.0003, np.abs(np.abs(positions[:, 0]) - 0.003) < 0.001
    assert np.abs(met[front & at_middle, 0]).min() > 0.85
    assert np.abs(met[front & clear, 0]).max() < 0.9


@pytest.mark.parametrize("row", ["teeth_upper", "teeth_lower"])
def test_canines_are_darkest_of_the_front_teeth_and_each_tooth_is_of_one_tone(row):
    positions, triangles, tooth = row_of("amber", row)
    tone = tones(positions, triangles, tooth)
    assert (tone[tooth < 0.5] == 0).all()
    assert len(np.unique(tone[tooth > 0.5])) == 14
    middle = (tooth > 0.5) & (np.abs(positions[:, 0]) < 0.002)
    assert tone[middle].max() < 0.5 < tone.max()


def test_a_tooth_alone_needs_no_gum():
    box = np.array([[x, y, z] for x in (-1, 1) for y in (0, 1) for z in (4, 5)], np.float32)
    triangles = np.array([[i, (i + 1) % 8, (i + 2) % 8] for i in range(8)], np.int32)
    places = crown_places(box, triangles, np.ones(8, np.float32))
    assert set(np.abs(places[:, 0])) == {1.0}
    assert set(places[:, 1]) == {0.0, 1.0}
    np.testing.assert_array_equal(meeting_places(box, triangles, np.ones(8, np.float32)), places)


def test_the_shirt_is_measured_from_its_collar():
    model = head_model("amber")
    vertices, triangles, weave = shirt(model)
    assert len(weave) == len(vertices) == triangles.max() + 1
    assert 0 <= weave[:, 0].min() <= weave[:, 0].max() <= np.pi + 1e-6
    # farther from the collar is lower and wider
    assert np.corrcoef(weave[:, 1], vertices[:, 1])[0, 1] < -0.8
    assert abs(weave[72:144, 1]).max() < 1e-6
