from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from agentface.head.model import load_model
from agentface.mesh.normals import vertex_normals
from agentface.studies.figures import (
    FIGURES,
    bones,
    breadth_first,
    cheek_cut,
    fibres,
    integrated_face,
    springs,
    tissue_expressions,
)
from agentface.tissue import tables
from agentface.tissue.layers import EPIDERMIS
from agentface.tissue.reading import anatomy_file, read_tissue
from agentface.tissue.solvers.adaptive import NodeSets
from agentface.tissue.tissue_file import NAMES

pytestmark = pytest.mark.slow


def picture(content):
    with Image.open(BytesIO(content)) as image:
        return np.asarray(image.convert("RGB"), int)


@pytest.fixture(scope="module")
def model():
    return load_model("amber", asymmetry=0.0)


@pytest.fixture(scope="module")
def tissue(model):
    return tables.of(model)


@pytest.fixture(scope="module")
def skull(model, tissue):
    return bones.bones_of(model, tissue.lattice)


def test_the_figures_are_known_by_name():
    assert {"springs", "integrated_face", "cheek_cut", "breadth_first", "tissue_expressions"} <= FIGURES.keys()


def test_the_patch_is_a_vertex_with_its_neighbours_and_all_springs_are_counted(model, tissue):
    middle, *around = springs.patch(model, tissue.lattice).tolist()
    edges = {tuple(edge) for edge in tissue.lattice.edges.tolist()}
    assert all((min(middle, other), max(middle, other)) in edges for other in around)
    assert len(around) == sum(middle in edge for edge in edges) >= 5
    assert sum(springs.spring_counts(tissue.lattice).values()) == tissue.lattice.spring_count


def test_springs_of_three_kinds_and_three_layers_are_seen():
    drawn = picture(springs.figures("amber")["tissue-springs.png"])[:, :600].reshape(-1, 3)
    for colour in (*springs.KINDS.values(), *springs.LAYERS.values()):
        assert (np.abs(drawn - colour).max(axis=1) < 36).sum() > 100, colour


def test_the_skull_has_eye_sockets_a_nose_and_teeth_and_no_ears(model, tissue, skull):
    kept = (skull.kept >= 0.0).all(axis=1)
    points = skull.points
    assert np.isfinite(points).all()
    places = {name: model.landmarks[name][:2] for name in ("pupil_l", "pupil_r", "nose_tip")}
    places["mouth"] = 0.5 * (model.landmarks["upper_lip_middle"] + model.landmarks["lower_lip_middle"])[:2]
    for name, place in places.items():
        across = points[:, :2] - place
        here = (np.hypot(*across.T) < 0.004) & (points[:, 2] > 0.0)
        assert here.any(), name
        assert not (kept & here).any(), name
    for name in ("glabella", "cheekbone_l", "pogonion", "zygion_r"):
        away = np.linalg.norm(points[kept] - model.landmarks[name], axis=1).min()
        depth = tissue.lattice.file.depth_mm[name.removesuffix("_l").removesuffix("_r")]
        assert 0.4 * depth < 1e3 * away < 1.6 * depth + 2.0, name
    ear = np.flatnonzero(model.material[:, 3] > 0.5)
    out = np.linalg.norm(points[ear, :2] - 1e-3 * tissue.lattice.rest[EPIDERMIS, ear, :2], axis=1)
    assert 1e3 * out.max() > 8.0, "the auricle stands out from the bone"


def test_the_picture_of_the_skull_keeps_to_the_tissues(tissue, skull):
    """Away from openings and ears, what is drawn is the bone that the tissue lies on."""
    own = 1e-3 * tissue.lattice.skull.points
    drawn = skull.points[: len(own)]
    whole = (skull.kept[: len(own)] > [0.8, 0.8, 0.8, 0.8, 0.0, 0.0]).all(axis=1) & tissue.lattice.free
    assert whole.sum() > 1000
    assert 1e3 * np.linalg.norm(own - drawn, axis=1)[whole].mean() < 0.5


def test_every_muscle_is_a_closed_surface_over_the_bone(model, tissue, skull):
    bed = fibres.Bed(skull.points, vertex_normals(skull.points, skull.triangles))
    muscles = fibres.bellies(model, tissue.lattice, read_tissue(anatomy_file()), bed)
    assert tuple(muscles) == NAMES
    for name, (points, triangles, colours) in muscles.items():
        assert np.isfinite(points).all(), name
        assert colours.shape == points.shape
        ends = np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)])
        once, count = np.unique(ends, axis=0, return_counts=True)
        assert (count == 1).all(), name
        open_ends = len({tuple(edge) for edge in once.tolist()} ^ {tuple(edge) for edge in once[:, ::-1].tolist()})
        assert open_ends in (0, 4 * fibres._SECTION), name
        inside = vertex_normals(points, triangles)
        assert ((points - points.mean(axis=0)) * inside).sum() > 0.0, f"{name} is turned inside out"
    left, right = (muscles[f"zygomaticus_major_{side}"].points for side in "lr")
    np.testing.assert_allclose(left.mean(axis=0), right.mean(axis=0) * [-1, 1, 1], atol=1e-3)


def test_muscles_cover_bone_and_the_net_covers_the_left_half(monkeypatch):
    monkeypatch.setattr(integrated_face, "_SIZE", 150)
    drawn = picture(integrated_face.figures("amber")["tissue-skull.png"])[12:162]
    skull, muscles, net = (drawn[:, 12 + 162 * i : 162 + 162 * i] for i in range(3))
    red = [((part[..., 0] > 1.7 * part[..., 1]) & (part[..., 0] > 90)).mean() for part in (skull, muscles, net)]
    assert red[0] < 0.01
    assert min(red[1:]) > 0.08
    dark = (skull.max(axis=2) < 60).mean()
    assert 0.02 < dark < 0.2, "sockets and nose"
    brightness = net.sum(axis=2)
    assert brightness[20:60, 78:105].mean() < brightness[20:60, 45:72].mean() - 20


def test_a_level_plane_cuts_triangles_in_two_points_and_prisms_in_polygons():
    upper = np.array([[0.0, -1, 0], [4, -1, 0], [0, 3, 0]])
    prism = np.stack([upper, upper - [0, 0, 2]])
    ends = cheek_cut.section(upper[None], 0.0)
    np.testing.assert_allclose(ends[np.argsort(ends[:, 0])], [[0, 0, 0], [3, 0, 0]])
    polygon = cheek_cut.section(prism, 0.0)
    x, z = polygon[:, 0], polygon[:, 2]
    area = 0.5 * abs(np.dot(x, np.roll(z, 1)) - np.dot(z, np.roll(x, 1)))
    assert len(polygon) == 4
    assert area == pytest.approx(6.0)
    assert len(cheek_cut.section(prism, 5.0)) == 0


def test_the_cut_shows_rest_and_a_smile_that_keeps_its_volume(model, tissue):
    height = 1e3 * float(model.landmarks["cheek_l"][1])
    smile = cheek_cut.contractions_of(tissue, "happiness")
    assert 0.0 < smile.max() <= 1.0
    rest, moved = (cheek_cut.cut(tissue, contractions, height) for contractions in (None, smile))
    np.testing.assert_array_equal(rest.surfaces[cheek_cut.BONE], moved.surfaces[cheek_cut.BONE])
    assert cheek_cut.volume_ratio(tissue.lattice, rest, rest) == 1.0
    assert 0.9 < cheek_cut.volume_ratio(tissue.lattice, rest, moved) < 1.1
    gone = np.linalg.norm(moved.surfaces - rest.surfaces, axis=2)
    assert gone[EPIDERMIS].max() > 1.0
    assert gone[:, tissue.lattice.members.fixed].max() == 0.0
    drawn = picture(cheek_cut.figures("amber")["tissue-cheek.png"])
    for colour in cheek_cut._COLOURS.values():
        assert (np.abs(drawn - colour).max(axis=2) < 12).sum() > 2000, colour


def test_columns_have_the_colour_of_their_set_and_distance():
    sets = NodeSets(np.array([0]), np.array([1, 2, 4]), np.array([0, 1, 2, -1, 7]), 1)
    colours = breadth_first.column_colours(sets)
    np.testing.assert_array_equal(colours[[0, 3]], [breadth_first.DYNAMIC, breadth_first.STATIC])
    assert len(np.unique(colours.round(), axis=0)) == 5
    blue = colours[[1, 2, 4]]
    assert (np.diff(blue[:, 2] - blue[:, 0]) > 0).all(), "from yellow to blue"


def test_the_order_is_drawn_on_the_mesh(monkeypatch):
    monkeypatch.setattr(breadth_first, "_SIZE", 200)
    drawn = picture(breadth_first.figures("amber")["tissue-order.png"])
    face = drawn[12:212, 12:212].reshape(-1, 3)
    red = (face[:, 0] > 1.8 * face[:, 1]).mean()
    grey = ((np.ptp(face, axis=1) < 14) & (face.max(axis=1) < 240)).mean()
    assert red > 0.05
    assert grey > 0.1


@pytest.mark.gl
def test_six_expressions_of_the_tissue_are_drawn(monkeypatch):
    assert tuple(tissue_expressions.EXPRESSIONS) == ("neutral", "happiness", "anger", "surprise", "sadness", "disgust")
    assert len(set(tissue_expressions.EXPRESSIONS.values())) == 6, "each from elsewhere"
    monkeypatch.setattr(tissue_expressions, "_SIZE", (60, 70))
    drawn = picture(tissue_expressions.figures("amber")["tissue-expressions.png"])
    cells = [drawn[12 + 134 * row : 82 + 134 * row, 12 + 72 * i : 72 + 72 * i] for row in range(2) for i in range(3)]
    assert all(np.abs(one - other).max() > 50 for i, one in enumerate(cells) for other in cells[:i])
