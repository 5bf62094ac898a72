import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.mesh.smoothstep import falloff, smoothstep

ENDS = st.tuples(st.floats(-5, 5), st.floats(-5, 5)).filter(lambda ends: abs(ends[0] - ends[1]) > 1e-3)


@given(ENDS, st.lists(st.floats(-20, 20), min_size=1, max_size=9))
def test_it_rises_from_0_to_1_between_its_ends_and_falloff_falls(ends, values):
    start, end = ends
    values = np.sort(np.array(values))
    found = smoothstep(start, end, values)
    assert found.shape == values.shape
    assert ((found >= 0) & (found <= 1)).all()
    rising = 1.0 if end > start else -1.0
    assert (rising * np.diff(found) >= -1e-12).all()
    np.testing.assert_allclose(falloff(values, start, end), 1.0 - found, atol=1e-15)


def test_its_ends_its_middle_and_its_slopes():
    assert smoothstep(2.0, 4.0, np.array([1.9, 2.0, 3.0, 4.0, 4.1])).tolist() == [0.0, 0.0, 0.5, 1.0, 1.0]
    near = smoothstep(0.0, 1.0, np.array([1e-4, 1.0 - 1e-4]))
    assert near == pytest.approx([3e-8, 1.0 - 3e-8], abs=1e-9)


def test_ends_may_differ_from_place_to_place():
    found = smoothstep(np.array([0.0, 1.0]), np.array([1.0, 3.0]), np.array([0.5, 2.0]))
    np.testing.assert_allclose(found, [0.5, 0.5])
