"""Normals of the skin by pairs of triangles: every triangle is in one of them, and its normals are the numpy form's."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform.finish import smooth_normals
from agentface.deform.finish import smooth_normals_compiled as compiled
from agentface.mesh.normals import vertex_normals
from tests.heads import head_model


def turned(triangles):
    """Each triangle from its lowest corner on, sorted."""
    first = triangles.argmin(axis=1)[:, None]
    return np.unique(np.take_along_axis(triangles, (first + np.arange(3)) % 3, axis=1), axis=0)


@pytest.mark.parametrize("face", ["amber", "onyx"])
def test_the_pairs_are_the_triangles(face):
    triangles = head_model(face).triangles
    quads = smooth_normals.quads_of(triangles)
    halves = np.concatenate([quads[:, :3], quads[quads[:, 3] != quads[:, 0]][:, [0, 2, 3]]])
    assert len(halves) == len(triangles)
    np.testing.assert_array_equal(turned(halves), turned(triangles))
    assert len(quads) < 0.55 * len(triangles)


def test_a_triangle_without_a_neighbour_stands_alone():
    quads = smooth_normals.quads_of(np.array([[0, 1, 2], [3, 4, 5], [2, 1, 6]], np.int32))
    assert sorted(map(set, quads.tolist()), key=min) == [{0, 1, 2, 6}, {3, 4, 5}]
    assert smooth_normals.quads_of(np.zeros((0, 3), np.int32)).shape == (0, 4)


@settings(max_examples=20)
@given(st.integers(0, 2**32))
def test_both_forms_agree(seed):
    model = head_model()
    tables = smooth_normals.prepare(model)
    shaken = 2e-4 * np.random.default_rng(seed).standard_normal(model.vertices.shape)
    vertices = (model.vertices + shaken).astype(np.float32)
    found, expected = (np.full_like(vertices, np.nan) for _ in range(2))
    compiled.apply(tables, vertices, found)
    smooth_normals.apply(tables, vertices, expected)
    # single precision, of the narrowest triangles
    np.testing.assert_allclose(found, expected, atol=5e-4)
    np.testing.assert_allclose(expected, vertex_normals(vertices, model.triangles), atol=1e-6)


def test_a_vertex_without_area_has_no_normal():
    tables = smooth_normals.SmoothNormalTables(np.zeros((1, 3), np.int32), np.zeros((1, 4), np.int32))
    for module in smooth_normals, compiled:
        out = np.full((2, 3), np.nan, np.float32)
        module.apply(tables, np.ones((2, 3), np.float32), out)
        np.testing.assert_array_equal(out, 0.0)
