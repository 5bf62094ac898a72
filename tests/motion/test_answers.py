"""The curve through the rules' last answers."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from agentface.motion import answers, answers_compiled
from agentface.motion.answers import LATE, TICKS, Answers
from agentface.parameters import MUSCLES

COUNT = 4
ROWS = arrays(np.float64, (TICKS, COUNT), elements=st.floats(0, 1))
PARTS = st.floats(0, 1)


def curve(rows, part, loop=answers_compiled.curve):
    out = np.full(rows.shape[1], np.nan)
    loop(rows, part, out)
    return out


@given(ROWS, PARTS, st.integers(1, 2 * TICKS))
def test_the_kernels_equal_their_numpy_twins(rows, part, new):
    np.testing.assert_allclose(curve(rows, part), curve(rows, part, answers.curve_in_numpy), atol=1e-15)
    pushed = np.arange(1.0, new * COUNT + 1.0).reshape(new, COUNT)
    first, second = rows.copy(), rows.copy()
    answers_compiled.push(first, pushed)
    answers.push_in_numpy(second, pushed)
    np.testing.assert_array_equal(first, second)
    np.testing.assert_array_equal(first, np.concatenate([rows, pushed])[-TICKS:])
    for row in (rows[0], rows[-1]):
        assert answers_compiled.all_(rows, row) == answers.all_in_numpy(rows, row)


@given(ROWS, PARTS)
def test_the_curve_stays_among_the_answers(rows, part):
    shown = curve(rows, part)
    assert (shown >= rows.min(axis=0) - 1e-15).all()
    assert (shown <= rows.max(axis=0) + 1e-15).all()


@given(arrays(np.float64, (TICKS + 1, COUNT), elements=st.floats(0, 1)))
def test_from_tick_to_tick_neither_the_curve_nor_its_speed_jumps(rows):
    before, after, near = rows[:-1], rows[1:], 1e-6
    np.testing.assert_allclose(curve(before, 1.0), curve(after, 0.0), atol=1e-12)
    leaving = (curve(before, 1.0) - curve(before, 1.0 - near)) / near
    arriving = (curve(after, near) - curve(after, 0.0)) / near
    np.testing.assert_allclose(leaving, arriving, atol=1e-4)


@given(st.floats(0, 1), PARTS)
def test_what_stays_is_shown_to_the_last_bit(level, part):
    assert (curve(np.full((TICKS, COUNT), level), part) == level).all()


def test_what_was_shown_earlier_can_be_shown_again():
    kept = Answers(compiled=True)
    shown = []
    for tick in range(3 * TICKS):
        kept.push(np.zeros((1, 6)), np.full((1, len(MUSCLES)), tick / (3 * TICKS)))
        shown.append(kept.at(0.3))
        if tick >= LATE:
            np.testing.assert_array_equal(kept.at(0.3, late=True), shown[tick - LATE])
