import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from agentface.mesh.evening import evened
from tests.heads import head_model

MODEL = head_model("amber")


@given(st.floats(-3, 3), st.integers(0, 4))
def test_a_constant_stays(value, times):
    field = np.full(len(MODEL.vertices), value)
    np.testing.assert_allclose(evened(field, MODEL.triangles, times), field, atol=1e-12)


def test_each_pass_goes_half_the_way_to_the_neighbours_mean():
    field = np.random.default_rng(0).random(len(MODEL.vertices))
    vertex = 2000
    ring = MODEL.triangles[(MODEL.triangles == vertex).any(axis=1)]
    around = np.setdiff1d(ring, [vertex])
    found = evened(field, MODEL.triangles, 1)
    np.testing.assert_allclose(found[vertex], 0.5 * field[vertex] + 0.5 * field[around].mean())
    assert np.ptp(evened(field, MODEL.triangles, 20)) < np.ptp(found) < np.ptp(field)


def test_what_is_not_free_stays_and_columns_are_alike():
    field = np.random.default_rng(1).random((len(MODEL.vertices), 2))
    free = MODEL.vertices[:, 1] > 0
    found = evened(field, MODEL.triangles, 3, free)
    np.testing.assert_array_equal(found[~free], field[~free])
    assert (found[free] != field[free]).any()
    np.testing.assert_array_equal(found[:, 1], evened(field[:, 1], MODEL.triangles, 3, free))
