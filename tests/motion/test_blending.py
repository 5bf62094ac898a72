"""What several channels want of the same parameters."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from agentface.motion.blending import Claim, Claims, blend_in_numpy
from agentface.motion.blending_compiled import blend
from agentface.parameters import COUNT, NAMES, WAYS

CHANNELS, SIZE = 4, 3
LOOPS = pytest.mark.parametrize("loop", [blend, blend_in_numpy], ids=["compiled", "numpy"])


@st.composite
def claims(draw):
    """Those of some channels, each of which names each of its parameters once."""
    found = []
    for channel in range(CHANNELS):
        for place, name in enumerate(draw(st.lists(st.sampled_from(NAMES[:6]), unique=True, max_size=SIZE))):
            found.append(
                Claim(draw(st.integers(0, 3)), channel, draw(st.sampled_from(WAYS)), SIZE * channel + place, name)
            )
    return Claims.of(found)


@given(
    claims(),
    arrays(np.bool_, CHANNELS),
    arrays(np.float64, CHANNELS * SIZE, elements=st.floats(-2, 2)),
    arrays(np.float64, CHANNELS * SIZE, elements=st.sampled_from([0.0, 0.3, 1.0])),
    arrays(np.float64, COUNT, elements=st.floats(-2, 2)),
)
def test_the_kernel_equals_its_numpy_twin(table, wants, values, weights, below):
    first, second = below.copy(), below.copy()
    blend(table, wants, np.stack([values, weights]), first)
    blend_in_numpy(table, wants, np.stack([values, weights]), second)
    np.testing.assert_array_equal(first, second)


@LOOPS
def test_wishes_go_over_one_another_by_priority_then_by_channel(loop):
    name = NAMES[0]
    table = Claims.of([Claim(2, 0, "add", 0, name), Claim(1, 1, "replace", 1, name), Claim(2, 1, "scale", 2, name)])
    shown = np.zeros(COUNT)
    loop(table, np.array([True, True]), np.array([[0.5, 0.2, 10.0], [1.0, 0.5, 1.0]]), shown)
    assert shown[0] == pytest.approx((0.1 + 0.5) * 10.0)
    assert not shown[1:].any()


@LOOPS
@pytest.mark.parametrize("way", WAYS)
def test_what_is_no_number_is_not_hidden(loop, way):
    for wanted, below in ((np.nan, 0.5), (0.5, np.nan)):
        shown = np.full(COUNT, below)
        table = Claims.of([Claim(0, 0, way, 0, NAMES[0])])
        loop(table, np.array([True]), np.array([[wanted], [1.0]]), shown)
        assert np.isnan(shown[0]) == (way != "replace" or np.isnan(wanted))


@LOOPS
def test_without_wishes_nothing_moves(loop):
    shown = np.full(COUNT, 0.5)
    loop(Claims.of([]), np.zeros(0, np.bool_), np.zeros((2, 0)), shown)
    assert (shown == 0.5).all()
