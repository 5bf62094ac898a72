"""Phones of words, moved to where they are heard."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.agents.word_fit import _edges, fitted, with_end
from agentface.speech.phones import Phone, phones_of
from agentface.speech.timed_words import TimedWord

MAMA = phones_of([("M", 1.0, 1.1), ("AA", 1.1, 1.2), ("M", 1.2, 1.3), ("AH", 1.3, 1.4)])


def edges_of(phones):
    return [phones[0].start_s, *(phone.end_s for phone in phones)]


def test_phones_are_said_where_they_are_heard():
    heard = phones_of([("B", 0.9, 1.06), ("AA", 1.06, 1.25), ("P", 1.25, 1.32), ("AA", 1.32, 1.5)])
    found = fitted(MAMA, heard)
    assert [phone.symbol for phone in found] == ["M", "AA", "M", "AH"]
    assert edges_of(found) == pytest.approx([1.0, 1.06, 1.25, 1.32, 1.4])


def test_what_nobody_hears_stays_where_it_is():
    assert fitted(MAMA, ()) == list(MAMA)
    assert fitted(MAMA, phones_of([("M", 3.0, 3.2)])) == list(MAMA)
    assert fitted(MAMA[:1], phones_of([("AA", 1.0, 1.2)])) == [MAMA[0]]
    strange = fitted(MAMA, phones_of([("sil", 0.0, 2.0)]))
    assert edges_of(strange) == pytest.approx(edges_of(MAMA), abs=0.011)


SYMBOLS = st.sampled_from(["M", "AA", "S", "IY", "UW", "sil", "T", "unheard of"])


@given(st.lists(st.tuples(SYMBOLS, st.floats(0.01, 0.4)), min_size=1, max_size=12), st.floats(0.0, 1.2))
def test_it_fills_the_same_time_in_the_same_order_whatever_is_heard(rows, start):
    heard, at = [], start
    for symbol, length in rows:
        heard.append(Phone(symbol, at, at + length))
        at += length
    found = fitted(MAMA, heard)
    assert [phone.symbol for phone in found] == [phone.symbol for phone in MAMA]
    assert (found[0].start_s, found[-1].end_s) == (1.0, 1.4)
    assert all(before.end_s == pytest.approx(after.start_s) for before, after in pairwise(found))
    assert min(phone.duration_s for phone in found) > 0.02


@given(st.integers(0, 999), st.integers(1, 3), st.integers(1, 2))
def test_no_other_edges_fit_better(seed, count, least):
    """Against all that there are."""
    scores = np.random.default_rng(seed).normal(size=(count, 8))

    def total(edges):
        return sum(scores[row, first:last].sum() for row, (first, last) in enumerate(pairwise(edges)))

    every = [
        (0, *inner, 8) for inner in combinations(range(1, 8), count - 1)
        if all(last - first >= least for first, last in pairwise((0, *inner, 8)))
    ]  # fmt: skip
    found = _edges(scores, least).astype(int)
    assert tuple(found) in every
    assert total(found) == pytest.approx(max(map(total, every)))


def test_a_word_ends_with_the_silence_or_where_the_next_begins():
    word, after = TimedWord("hello", 1.0), TimedWord("you", 2.5)
    assert with_end(word, after, ()).end_s == 2.5
    pause = phones_of([("HH", 1.0, 1.4), ("sil", 1.4, 2.4)])
    assert with_end(word, after, pause).end_s == 1.4
    assert with_end(word, after, phones_of([("sil", 1.0, 1.05), ("AA", 1.05, 2.5)])).end_s == 2.5
    assert with_end(word, None, ()).end_s == pytest.approx(1.45)
    assert with_end(TimedWord("hello", 1.0, 1.2), after, pause).end_s == 1.2
    assert with_end(TimedWord("hello", 1.0, 3.0), after, ()).end_s == 2.5
