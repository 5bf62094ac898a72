from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.io.osc.pattern import LONGEST, is_pattern, matches


@pytest.mark.parametrize(
    ("pattern", "address", "expected"),
    [
        ("/a/b", "/a/b", True),
        ("/a/*", "/a/b", True),
        ("/a/*", "/a/b/c", False),
        ("/*/*/c", "/a/b/c", True),
        ("/a/*b*", "/a/xxbyy", True),
        ("/a/*b", "/a/ba", False),
        ("/a/**", "/a/b", True),
        ("/?", "/a", True),
        ("/?", "/", False),
        ("/a?", "/a", False),
        ("/[a-c]x", "/bx", True),
        ("/[a-c]x", "/dx", False),
        ("/[!a-c]x", "/dx", True),
        ("/[!a-c]x", "/bx", False),
        ("/[a-]", "/-", True),
        ("/[a!]", "/!", True),
        ("/[xa-cy]", "/y", True),
        ("/{foo,bar}", "/bar", True),
        ("/{foo,bar}", "/baz", False),
        ("/{foo,fo}o", "/foo", True),
        ("/x{,y}z", "/xz", True),
        ("/{a,b}*[0-9]", "/bxx7", True),
        ("/[]", "/a", False),
        ("/{a", "/a", False),
        ("/[a", "/a", False),
        ("/a]", "/a]", False),
        ("/}", "/}", False),
        ("/{a/b}", "/a/b", False),
    ],
)
def test_by_the_specification(pattern, address, expected):
    assert matches(pattern, address) is expected


PIECES = st.one_of(
    st.sampled_from("abc"),
    st.just("*"),
    st.just("?"),
    st.sampled_from(["[ab]", "[!ab]", "[a-c]", "[!a-b]"]),
    st.lists(st.text("abc", max_size=3), min_size=1, max_size=3).map(lambda words: "{" + ",".join(words) + "}"),
)


def as_expression(piece):
    """The same as a regular expression."""
    if piece.startswith("{"):
        return "(?:" + "|".join(piece[1:-1].split(",")) + ")"
    if piece.startswith("["):
        return piece.replace("!", "^").replace("]", "/]") if "!" in piece else piece
    return {"*": "[^/]*", "?": "[^/]"}.get(piece, piece)


@given(
    st.lists(st.lists(PIECES, max_size=4), min_size=1, max_size=2),
    st.lists(st.text("abcd", max_size=5), min_size=1, max_size=2),
)
def test_as_regular_expressions_match(parts, words):
    pattern, address = ("".join(f"/{''.join(part)}" for part in given) for given in (parts, words))
    expression = "".join("/" + "".join(map(as_expression, part)) for part in parts)
    assert matches(pattern, address) is bool(re.fullmatch(expression, address))


@given(st.text("ab/*?[]{},!-", max_size=40), st.text("ab/", max_size=12))
def test_any_text_matches_or_does_not(pattern, address):
    assert matches("/" + pattern, "/" + address) in (True, False)


def test_a_pattern_made_to_take_long_does_not():
    """To follow one way after the other would outlast pytest's time limit."""
    address = "/" + "a" * 200
    for pattern in ("/" + "*a" * 100 + "b", "/" + "{a,aa}" * 42, "/" + "{a,a,a,a}*" * 25):
        assert len(pattern) <= LONGEST
        matches(pattern, address)
    assert not matches("/" + "*" * LONGEST, address)


def test_what_is_a_pattern():
    assert not is_pattern("/agentface/look_at")
    assert all(is_pattern(f"/a{char}") for char in "*?[]{}")
