"""What the two sides of a pair make of one muscle."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from agentface.motion.sides import Sides, to_sides_in_numpy
from agentface.motion.sides_compiled import to_sides

MUSCLES, COUNT = 3, 5
LEVELS = arrays(np.float64, MUSCLES, elements=st.floats(0, 1))
SIDES = st.builds(
    Sides,
    arrays(np.int32, COUNT, elements=st.integers(0, MUSCLES - 1)),
    arrays(np.float64, COUNT, elements=st.floats(0, 1)),
    arrays(np.float64, COUNT, elements=st.floats(0.8, 1.2)),
)


def shown(loop, *arguments):
    out = np.full(COUNT, np.nan)
    loop(*arguments, out)
    return out


@given(LEVELS, LEVELS, st.floats(0, 1), SIDES)
def test_the_kernel_equals_its_numpy_twin(now, earlier, apart, sides):
    first, second = (shown(loop, now, earlier, apart, sides) for loop in (to_sides, to_sides_in_numpy))
    np.testing.assert_allclose(first, second, atol=1e-15)


@given(LEVELS, LEVELS, SIDES)
def test_a_side_that_is_late_is_between_what_was_and_what_is(now, earlier, sides):
    part = shown(to_sides, now, earlier, 1.0, sides) / sides.gains
    low, high = np.minimum(now, earlier)[sides.muscles], np.maximum(now, earlier)[sides.muscles]
    assert ((part >= low - 1e-12) & (part <= high + 1e-12)).all()
    np.testing.assert_array_equal(shown(to_sides, now, earlier, 0.0, sides), now[sides.muscles] * sides.gains)
