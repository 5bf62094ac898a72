import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from agentface.mesh import normals_compiled
from agentface.mesh.normals import vertex_normals, write_normals
from tests.deform.rig import make_rig


def compute(vertices, triangles):
    out = np.full_like(vertices, np.nan)
    normals_compiled.write_normals(vertices, triangles.astype(np.int32), out)
    return out


def ball(count=600):
    draw = np.random.default_rng(1).normal(size=(count, 3))
    points = draw / np.linalg.norm(draw, axis=1, keepdims=True)
    triangles = ConvexHull(points).simplices.copy()
    corners = points[triangles]
    inward = np.linalg.det(corners) < 0
    triangles[inward] = triangles[inward][:, ::-1]
    return (0.1 * points).astype(np.float32), triangles


def test_the_normals_of_a_ball_point_away_from_its_centre():
    points, triangles = ball()
    normals = compute(points, triangles)
    assert (np.einsum("ij,ij->i", normals, points) / 0.1 > 0.95).all()


def test_a_corner_weighs_its_triangles_by_area():
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 2]], np.float32)
    normals = compute(points, np.array([[0, 1, 2], [0, 2, 3]]))
    assert normals[0] == pytest.approx(np.array([2, 0, 1]) / np.sqrt(5), abs=1e-6)
    assert normals[1] == pytest.approx([0, 0, 1])


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**31))
def test_the_kernel_equals_its_numpy_twin(seed):
    face = make_rig()
    shaken = face.vertices + np.random.default_rng(seed).normal(0, 3e-4, face.vertices.shape).astype(np.float32)
    assert np.abs(compute(shaken, face.triangles) - vertex_normals(shaken, face.triangles)).max() < 1e-3


def test_a_vertex_without_area_gets_zero():
    points = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0], [5, 5, 5]], np.float32)
    triangles = np.array([[0, 1, 2]])
    assert not compute(points, triangles).any()
    assert not vertex_normals(points, triangles).any()
    out = np.full_like(points, np.nan)
    write_normals(points, triangles, out)
    assert not out.any()
