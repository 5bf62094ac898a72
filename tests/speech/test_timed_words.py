from __future__ import annotations

from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.errors import InvalidValueError
from agentface.speech.phones import phones_of
from agentface.speech.timed_words import PHONE_S, TimedWord, phones_of_words, plain_words

WORDS = {"mama": ("M", "AA1", "M", "AH0"), "it's": ("IH", "T", "S"), "go": ("G", "OW")}


def lookup(word):
    return WORDS.get(word, ())


def test_a_word_fills_its_time_and_its_vowels_are_longer():
    phones = phones_of_words([TimedWord("Mama!", 1.0, 1.52)], lookup)
    assert [phone.symbol for phone in phones] == ["M", "AA1", "M", "AH0"]
    assert [phone.duration_s for phone in phones] == pytest.approx([0.1, 0.16, 0.1, 0.16])
    assert (phones[0].start_s, phones[-1].end_s) == pytest.approx((1.0, 1.52))


def test_without_an_end_it_lasts_as_usual_and_not_into_the_next():
    alone = phones_of_words([TimedWord("go", 0.5)], lookup)
    assert alone[-1].end_s == pytest.approx(0.5 + 2 * PHONE_S)
    both = phones_of_words([TimedWord("mama", 0.6, 0.9), TimedWord("go", 0.5)], lookup)
    assert both[1].end_s == pytest.approx(0.6)
    assert [phone.symbol for phone in both] == ["G", "OW", "M", "AA1", "M", "AH0"]


def test_marks_capitals_and_unknown_words():
    assert plain_words('"It\u2019s", she said -- go_on 42!') == ["it's", "she", "said", "go", "on", "42"]
    assert [p.symbol for p in phones_of_words([TimedWord("It\u2019s...", 0.0)], lookup)] == ["IH", "T", "S"]
    assert phones_of_words([TimedWord("zyx", 0.0), TimedWord("", 1.0)], lookup) == ()
    assert phones_of_words([], lookup) == ()


@given(st.lists(st.tuples(st.sampled_from(["mama", "go", "zyx", ""]), st.floats(0, 20), st.floats(0, 3)), max_size=8))
def test_phones_never_overlap_whatever_the_words(rows):
    words = [TimedWord(text, start, None if length > 2 else start + length) for text, start, length in rows]
    phones = phones_of_words(words, lookup)
    assert phones_of(phones) == phones
    assert all(before.end_s <= after.start_s + 1e-9 for before, after in pairwise(phones))


@pytest.mark.parametrize("word", [(5, 0.0), ("x" * 81, 0.0), ("a", -0.1), ("a", 1.0, 0.5), ("a", float("nan"))])
def test_what_is_no_word_is_refused(word):
    with pytest.raises(InvalidValueError):
        TimedWord(*word)
