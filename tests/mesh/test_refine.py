import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.mesh.normals import vertex_normals
from agentface.mesh.refine import refine, unrefined
from tests.heads import head_model

OCTAHEDRON = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], np.float32)
FACES = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]], np.int32)


def area_and_volume(vertices, triangles):
    a, b, c = (vertices[triangles[:, i]].astype(float) for i in range(3))
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum(), (a * np.cross(b, c)).sum() / 6


def test_curved_edges_of_a_coarse_ball_lie_close_to_the_sphere():
    first = refine(FACES, len(OCTAHEDRON))
    ball = first.mean(OCTAHEDRON)
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    second = refine(first.triangles, len(ball))
    curved = np.linalg.norm(second.positions(ball, ball), axis=1)
    straight = np.linalg.norm(second.mean(ball), axis=1)
    assert len(second.triangles) == 16 * len(FACES)
    assert np.abs(curved - 1).max() < 0.03
    assert np.abs(straight - 1).max() > 0.07
    assert (vertex_normals(second.positions(ball, ball), second.triangles) * second.mean(ball)).sum(1).min() > 0.7


def test_flat_meshes_stay_flat_and_keep_their_area_and_winding():
    vertices = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32)
    triangles = np.array([[0, 1, 2], [0, 2, 3]], np.int32)
    finer = refine(triangles, 4)
    placed = finer.positions(vertices, np.tile(np.float32([0, 0, 1]), (4, 1)))
    assert len(placed) == 9  # four corners and five edges
    assert (placed[:, 2] == 0).all()
    np.testing.assert_array_equal(vertex_normals(placed, finer.triangles), np.tile([0, 0, 1], (9, 1)))
    assert area_and_volume(placed, finer.triangles)[0] == pytest.approx(1.0)


@pytest.mark.parametrize("face", ["amber", "onyx"])
def test_refined_heads_keep_their_vertices(face):
    model = head_model(face)
    normals = vertex_normals(model.vertices, model.triangles)
    finer = refine(model.triangles, len(model.vertices))
    placed = finer.positions(model.vertices, normals)
    np.testing.assert_allclose(placed[: len(model.vertices)], model.vertices, atol=1e-7)
    coarse = unrefined(model.triangles, len(model.vertices))
    np.testing.assert_allclose(coarse.positions(model.vertices, normals), model.vertices, atol=1e-7)
    # curved edges leave straight ones by less than a fifth of their length
    flat = finer.mean(model.vertices)
    edge = np.linalg.norm(model.vertices[finer.ends[:, 0]] - model.vertices[finer.ends[:, 1]], axis=1)
    assert (np.linalg.norm(placed - flat, axis=1) <= 0.25 * edge + 1e-7).all()


@pytest.mark.parametrize("seed", range(3))
def test_any_edges_may_be_cut_and_the_mesh_stays_closed(seed):
    rng = np.random.default_rng(seed)
    first = refine(FACES, len(OCTAHEDRON))
    ball = first.positions(OCTAHEDRON, OCTAHEDRON)
    finer = refine(first.triangles, len(ball), lambda ends: rng.random(len(ends)) < 0.5)
    assert 0 < len(finer.ends) - len(ball) < 48  # of 48 edges
    edges = np.concatenate([finer.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    there, back = ({tuple(edge) for edge in way.tolist()} for way in (edges, edges[:, ::-1]))
    assert there == back  # each edge once in either direction
    assert len(there) == len(edges)
    flat, before = area_and_volume(finer.mean(ball), finer.triangles), area_and_volume(ball, first.triangles)
    assert flat == pytest.approx(before)


@given(st.floats(0.1, 10), st.integers(0, 2**32 - 1))
def test_normals_do_not_depend_on_scale_or_place(scale, seed):
    rng = np.random.default_rng(seed)
    moved = (OCTAHEDRON * scale + rng.uniform(-1, 1, 3)).astype(np.float32)
    np.testing.assert_allclose(vertex_normals(moved, FACES), OCTAHEDRON, atol=1e-4)
