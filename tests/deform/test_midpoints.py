"""Vertices between rings stay in the middle, in both forms."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform import midpoints
from agentface.deform import midpoints_compiled as compiled
from agentface.head.resample import subdivided
from tests.heads import head_model

MODEL = head_model("amber")
FINEST = subdivided(subdivided(MODEL))


@settings(max_examples=5)
@given(st.integers(0, 2**32))
def test_both_forms_put_each_vertex_between_its_two(seed):
    tables = midpoints.prepare(FINEST)
    start = np.random.default_rng(seed).random(FINEST.vertices.shape, np.float32)
    points, same = start.copy(), start.copy()
    midpoints.apply(tables, points)
    compiled.apply(tables, same)
    np.testing.assert_array_equal(points, same)
    vertex, one, other = tables.rows.T
    np.testing.assert_allclose(points[vertex], 0.5 * (points[one] + points[other]), atol=1e-7)
    others = np.setdiff1d(np.arange(len(start)), vertex)
    np.testing.assert_array_equal(points[others], start[others])


def test_a_face_as_it_was_read_has_none():
    assert midpoints.prepare(MODEL).rows.shape == (0, 3)
