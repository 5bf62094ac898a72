"""What every face that ships must be."""

import copy
import dataclasses
import json
import pickle
import struct
from itertools import pairwise

import numpy as np
import pytest

from agentface.head.look import load_look
from agentface.head.regions import REGIONS, SUB_REGIONS
from agentface.resources import face_folder, face_names
from tests.heads import head_model

FACES = ("amber", "onyx")
MESHES = {"skin", "teeth_upper", "teeth_lower", "tongue", "eye_l", "eye_r", "lashes"}


@pytest.fixture(scope="module", params=FACES)
def model(request):
    return head_model(request.param)


def triangle_normals(vertices, triangles):
    a, b, c = (vertices[triangles[:, i]].astype(np.float64) for i in range(3))
    return np.cross(b - a, c - a)


def test_two_faces_ship():
    assert face_names() == FACES


@pytest.mark.parametrize("face", FACES)
def test_a_face_has_its_files_and_is_small(face):
    folder = face_folder(face)
    assert sum(path.stat().st_size for path in folder.iterdir()) < 3_000_000
    assert "CC0" in (folder / "PROVENANCE.md").read_text()


def test_density_is_where_expression_happens(model):
    assert 4000 <= len(model.vertices) <= 6500
    ends = np.concatenate([model.triangles[:, [0, 1]], model.triangles[:, [1, 2]]])
    lengths = np.linalg.norm(model.vertices[ends[:, 0]] - model.vertices[ends[:, 1]], axis=1)
    middle = model.vertices[ends].mean(1)
    brow, hairline = model.landmarks["brow_middle_l"], model.landmarks["hairline_middle"]
    forehead = (middle[:, 1] > brow[1] + 0.012) & (middle[:, 1] < hairline[1] - 0.012) & (abs(middle[:, 0]) < brow[0])
    forehead &= middle[:, 2] > 0
    # a furrow of 1.5 mm height is some 8 mm wide: four edges across it
    assert np.median(lengths[forehead]) < 0.0027


def test_vertices_are_ordered_by_region(model):
    assert (np.diff(model.regions.region_of.astype(int)) >= 0).all()
    assert set(model.regions.region_of) == set(range(len(REGIONS)))
    for sub, owner in SUB_REGIONS.items():
        for side in "lr":
            inside = model.regions.region_of[model.regions.members(f"{sub}_{side}")]
            assert set(inside) == {REGIONS.index(f"{owner}_{side}")}


def test_the_skin_is_symmetric(model):
    np.testing.assert_allclose(model.vertices[model.mirror] * [-1, 1, 1], model.vertices, atol=1e-6)
    faces = {tuple(np.roll(t, -int(np.argmin(t)))) for t in model.triangles.tolist()}
    mirrored = {tuple(np.roll(t, -int(np.argmin(t)))) for t in model.mirror[model.triangles[:, ::-1]].tolist()}
    assert faces == mirrored


def test_no_triangle_is_flipped_or_degenerate(model):
    normals = triangle_normals(model.vertices, model.triangles)
    areas = np.linalg.norm(normals, axis=1) / 2
    assert areas.min() > 1e-9
    # a consistent surface has each directed edge once
    edges = np.concatenate([model.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    assert len(np.unique(edges, axis=0)) == len(edges)
    # neighbours across an edge do not fold over each other, except where skin folds: lips, lids, nostrils, ears
    owner = {tuple(edge): i % len(model.triangles) for i, edge in enumerate(edges.tolist())}
    unit = normals / np.linalg.norm(normals, axis=1, keepdims=True)
    material = model.material[model.triangles].max(1)
    smooth = (material[:, 0] < 0.05) & (material[:, 1] < 0.05) & (material[:, 2] < 0.05) & (material[:, 3] < 0.05)
    folded = [
        (a, b)
        for (a, b), face in owner.items()
        if (b, a) in owner and smooth[face] and smooth[owner[b, a]] and unit[face] @ unit[owner[b, a]] < 0.0
    ]
    assert not folded, f"{len(folded)} edges folded by more than 90 degrees"


def test_lips_are_closed_at_rest(model):
    rings = model.lips.rings
    across = np.linspace(-0.8, 0.8, 41) * model.landmarks["mouth_corner_l"][0]

    def height(half):
        points = model.vertices[half]
        order = np.argsort(points[:, 0])
        return np.interp(across, points[order, 0], points[order, 1])

    upper = np.min([height(ring.upper) for ring in rings[:5]], axis=0)
    lower = np.max([height(ring.lower) for ring in rings[:5]], axis=0)
    gap_mm = 1e3 * (upper - lower)
    assert gap_mm.max() < 0.25
    assert gap_mm.min() > 0.0, "the lips touch, but do not run into each other"


def test_rings_are_ordered_closed_and_symmetric(model):
    edges = {tuple(sorted(edge)) for t in model.triangles.tolist() for edge in zip(t, t[1:] + t[:1], strict=True)}
    all_rings = [*model.lips.rings, *model.eyelids.rings["l"], *model.eyelids.rings["r"]]
    for ring in all_rings:
        assert ring.upper[0] == ring.lower[0]
        assert ring.upper[-1] == ring.lower[-1]
    steps = [step for ring in model.lips.rings[:7] for half in (ring.upper, ring.lower) for step in pairwise(half)]
    assert all(tuple(sorted(step)) in edges for step in steps)
    for left, right in zip(model.eyelids.rings["l"], model.eyelids.rings["r"], strict=True):
        assert {int(model.mirror[vertex]) for vertex in left.upper} == set(right.upper)


def test_the_artists_shapes_are_kept_sparse_and_symmetric(model):
    assert len(model.shapes) == 52
    smile = {side: model.shapes[f"mouthSmile{side}"].dense(len(model.vertices)) for side in ("Left", "Right")}
    np.testing.assert_allclose(smile["Left"][model.mirror] * [-1, 1, 1], smile["Right"], atol=1e-6)
    assert np.linalg.norm(smile["Left"], axis=1).max() > 0.01
    assert sum(len(shape.indices) for shape in model.shapes.values()) < 0.4 * 52 * len(model.vertices)


def test_the_parts_lie_inside_the_head(model):
    low, high = model.vertices.min(0), model.vertices.max(0)
    for name, part in model.parts.items():
        positions = part.attributes["POSITION"]
        assert (positions > low).all(), name
        assert (positions < high).all(), name


def test_the_asset_is_read_as_an_independent_reader_reads_it():
    pygltflib = pytest.importorskip("pygltflib")
    path = face_folder("amber") / "head.glb"
    with pytest.MonkeyPatch.context():
        document = pygltflib.GLTF2.load_binary(str(path))
    skin = next(mesh for mesh in document.meshes if mesh.name == "skin")
    accessor = document.accessors[skin.primitives[0].attributes.POSITION]
    view = document.bufferViews[accessor.bufferView]
    raw = document.binary_blob()[view.byteOffset : view.byteOffset + accessor.count * 12]
    np.testing.assert_array_equal(np.frombuffer(raw, np.float32).reshape(-1, 3), head_model("amber").vertices)


def test_the_glb_header_is_right():
    content = (face_folder("onyx") / "head.glb").read_bytes()
    magic, version, length, chunk, kind = struct.unpack_from("<4sIII4s", content)
    assert (magic, version, length, kind) == (b"glTF", 2, len(content), b"JSON")
    assert {mesh["name"] for mesh in json.loads(content[20 : 20 + chunk])["meshes"]} == MESHES


def test_muscles_fade_out_at_borders_and_over_the_bone(model):
    muscles = model.muscles
    ends = np.concatenate([model.triangles[:, [0, 1]], model.triangles[:, [1, 2]]])
    lengths = np.linalg.norm(model.vertices[ends[:, 0]] - model.vertices[ends[:, 1]], axis=1)
    for row, reach in enumerate(muscles.reach):
        steps = np.abs(np.diff(reach[ends], axis=1))[:, 0] / (lengths / model.landmarks.eye_separation)
        assert steps.max() < 20, "no cliff: a border takes a twentieth of an eye separation at the least"
        distance = np.linalg.norm(model.vertices - muscles.origin[row], axis=1)
        length = np.linalg.norm(muscles.insertion[row] - muscles.origin[row])
        assert reach[distance < 0.05 * length].max(initial=0.0) < 0.05


def test_a_muscle_moves_only_its_regions(model):
    file = model.muscles_file
    for name, reach in zip(model.muscles.names, model.muscles.reach, strict=True):
        row = file.muscles[name[:-2]]
        allowed = model.regions.mask(row.regions)
        if row.not_regions:
            allowed &= ~model.regions.mask(row.not_regions)
        assert reach[~allowed].max() == 0.0
        assert reach[allowed].max() > 0.9


@pytest.mark.parametrize("through", [lambda model: pickle.loads(pickle.dumps(model)), copy.deepcopy])  # noqa: S301
def test_a_model_and_a_look_are_pickled_and_copied_whole(model, through):
    again = through(model)
    assert again is not model
    assert again == model
    assert hash(again) == hash(model)
    assert again.muscles.names == model.muscles.names
    assert len(again.trains) == len(model.trains)
    assert (again.eyes, again.lips, again.regions.ranges) == (model.eyes, model.lips, model.regions.ranges)
    look = load_look(model)
    assert through(look) == look


def test_models_differ_by_any_of_what_they_are_made_of(model):
    moved = model.vertices.copy()
    moved[7, 1] += 1e-6
    smile = {**model.shapes, "mouthSmileLeft": model.shapes["mouthSmileRight"]}
    jaw = model.jaw.model_copy(update={"widest_deg": 9})
    others = [{"vertices": moved}, {"shapes": smile}, {"name": "other"}, {"jaw": jaw}]
    assert dataclasses.replace(model) == model
    for change in others:
        assert dataclasses.replace(model, **change) != model
    assert model != "amber"
