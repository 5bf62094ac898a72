from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.errors import InvalidValueError
from agentface.speech.phones import Phone, phones_of


@pytest.mark.parametrize(
    "row",
    [
        ("", 0, 1), (" ", 0, 1), ("a" * 17, 0, 1), (3, 0, 1), (None, 0, 1), ("aa", math.nan, 1), ("aa", 0, math.inf),
        ("aa", "0", 1), ("aa", 1, 0.5), ("aa", 0, 1e9), ("aa", True, 2), ("aa", 0), "aa1", 5, ("aa", 0, 1, 2),
    ],
)  # fmt: skip
def test_what_is_no_phone_is_refused(row):
    with pytest.raises(InvalidValueError):
        phones_of([row])


def test_triples_and_phones_are_the_same():
    rows = [("p", 0, 0.1), ["aa", 0.1, 0.3], Phone("s", 0.35, 0.35)]
    assert phones_of(rows) == (Phone("p", 0.0, 0.1), Phone("aa", 0.1, 0.3), Phone("s", 0.35, 0.35))


@given(st.lists(st.floats(0, 0.5), min_size=2, max_size=9))
def test_phones_come_one_after_the_other(durations):
    times = [sum(durations[:n]) for n in range(len(durations) + 1)]
    rows = [("aa", start, end) for start, end in pairwise(times)]
    assert len(phones_of(rows)) == len(durations)
    longest = max(range(len(durations)), key=lambda n: durations[n])
    if durations[longest] > 0.01:
        rows.insert(longest + 1, ("ih", times[longest], times[longest] + 0.001))
        with pytest.raises(InvalidValueError, match="ih"):
            phones_of(rows)
