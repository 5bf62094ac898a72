"""The fine lips of a portrait: watertight, through the vertices, and carried along with them."""

from collections import Counter

import numpy as np
import pytest

from agentface.deform.mouth import lips as deformer
from agentface.mesh.normals import vertex_normals
from agentface.mesh.refine import refine
from agentface.parameters import FacePose
from agentface.view.skin.fine_lips import FineLips
from tests.heads import head_model

FACES = {face: head_model(face) for face in ("amber", "onyx")}
MM = 1e-3


@pytest.fixture(params=FACES)
def model(request):
    return FACES[request.param]


def puckered(model):
    tables = deformer.prepare(model)
    points = np.concatenate([model.vertices, tables.control_rest])
    deformer.contract(
        tables, FacePose.of(orbicularis_oris_pucker=1.0).array, deformer.as_they_lie(tables, points), points
    )
    deformer.surface(tables, points)
    return points[: len(model.vertices)]


def drawn(model, mesh, lips, vertices):
    """Where every vertex of the mesh comes to lie, as the shaders place it."""
    normals = vertex_normals(vertices, model.triangles)
    places, facing = lips.update(vertices, normals)
    return mesh.positions(np.concatenate([vertices, places]), np.concatenate([normals, facing]))


@pytest.mark.slow
@pytest.mark.parametrize("per_cell", [2, 4])
def test_the_mesh_is_as_closed_as_the_skins(model, per_cell):
    skin = refine(model.triangles, len(model.vertices))
    mesh = FineLips(model, per_cell).mesh(skin)

    def borders(triangles):
        edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        counted = Counter(map(tuple, np.sort(edges, axis=1).tolist()))
        assert max(counted.values()) == 2
        return {edge for edge, count in counted.items() if count == 1}

    assert borders(mesh.triangles) == borders(skin.triangles)


@pytest.mark.slow
@pytest.mark.untraced
def test_fine_lips_pass_through_the_vertices_and_stay_near_the_mesh(model):
    lips = FineLips(model, 4)
    for vertices in (model.vertices, puckered(model)):
        places, normals = lips.update(vertices, vertex_normals(vertices, model.triangles))
        assert len(places) == lips.count
        patch = deformer.prepare(model).patch
        apart = np.linalg.norm(vertices[patch][:, None] - places[None], axis=2)
        assert apart.min(1).max() < 1e-6
        assert apart.min(0).max() < 4.5 * MM  # half the diagonal of the largest cell
        np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1.0, atol=1e-5)


@pytest.mark.slow
@pytest.mark.untraced
def test_fine_lips_are_smoother_than_the_mesh(model):
    """Between neighbouring triangles of the puckered lips the largest angles get smaller, and none turns over."""
    lips, vertices = FineLips(model, 4), puckered(model)
    skin = refine(model.triangles, len(model.vertices))
    patch = deformer.prepare(model).patch
    bends = []
    for mesh in (skin, lips.mesh(skin)):
        places = drawn(model, mesh, lips, vertices)
        ends = np.where(mesh.ends < len(model.vertices), mesh.ends, patch[0])
        triangles = mesh.triangles[np.isin(ends, patch).all(1)[mesh.triangles].all(1)]
        a, b, c = (places[triangles[:, corner]].astype(np.float64) for corner in range(3))
        faces = np.cross(b - a, c - a)
        faces /= np.linalg.norm(faces, axis=1, keepdims=True)
        beside = {}
        for number, triangle in enumerate(triangles.tolist()):
            for corner in range(3):
                beside.setdefault(frozenset((triangle[corner], triangle[corner - 1])), []).append(number)
        pairs = np.array([pair for pair in beside.values() if len(pair) == 2])
        bends.append((faces[pairs[:, 0]] * faces[pairs[:, 1]]).sum(1))
    assert np.quantile(bends[1], 0.05) > np.quantile(bends[0], 0.05)
    assert (bends[1] < 0.0).mean() <= (bends[0] < 0.0).mean() + 1e-4


def test_a_wide_open_mouth_has_no_waves_between_its_vertices(model):
    lips = FineLips(model, 2)
    vertices = model.vertices + model.shapes["jawOpen"].dense(len(model.vertices))
    places, _ = lips.update(vertices, vertex_normals(vertices, model.triangles))
    grid = places.reshape(lips._fine.rings, lips._fine.columns, 3)
    between = 0.5 * (grid[:, 0::2] + np.roll(grid, -2, axis=1)[:, 0::2])
    assert np.linalg.norm(grid[:, 1::2] - between, axis=2).max() < 1.2 * MM


def test_fields_go_along(model):
    lips = FineLips(model, 2)
    extended = lips.extended(model.material)
    assert extended.shape == (len(model.vertices) + lips.count, 4)
    np.testing.assert_array_equal(extended[: len(model.vertices)], model.material)
    assert extended.min() >= 0
    assert extended.max() <= 1
    np.testing.assert_allclose(lips.extended(model.vertices)[len(model.vertices) :], lips._rest_fine, atol=2e-4)
