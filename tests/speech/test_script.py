from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.errors import InvalidValueError
from agentface.speech.script import Line, Script
from agentface.speech.tags import Tag, split_tags
from agentface.speech.text import LONGEST_SENTENCE, MOST_CHARACTERS, sentences, spoken

PIECES = ["[joy]", "[x]", "[face:surprise:0.5]", "Word.", "word", "😀", "\n", "*", "["]
LONG = ["[", "](", "**", "http://", "<a", "`", "```", "\n- ", "_ ", ". ", "&", "[joy]", "。"]


def known(name: str) -> str | None:
    return {"joy": "happiness", "surprise": "surprise", "neutral": "neutral"}.get(name.lower())


def said(text: str) -> list[str]:
    return [line.text for line in Script.of(text, known).lines]


@pytest.mark.parametrize(
    ("text", "heard"),
    [
        ("Mr. Smith paid $3.50. J. Doe did not!", ["Mr. Smith paid $3.50.", "J. Doe did not!"]),
        ("So do I. Then we went, e.g. home.", ["So do I.", "Then we went, e.g. home."]),
        ('"Stop!" she said. "Why?"', ['"Stop!"', "she said.", '"Why?"']),
        ("你好。世界！", ["你好。", "世界！"]),  # noqa: RUF001
        ("Well... maybe.", ["Well...", "maybe."]),
        ("# Title\n* one\n* **two**\n\nend of\nit", ["Title", "one", "two", "end of it"]),
        ("See [the page](https://a.example/b_c?d=1).", ["See the page."]),
        ("At https://me:pw@www.example.com/x/y?q=1. Or (http://b.example).", ["At example.com.", "Or (b.example)."]),
        ("Run `ls`:\n```sh\nrm -rf /\n```\nDone.", ["Run ls:", "Done."]),
        ("Hi 😀👍🏽 you ❤️ 1️⃣", ["Hi you 1"]),
        ("<b>Bold</b> R&D, 3 < 4", ["Bold R and D, 3 < 4"]),
        ("a\x00b\x1b[31mc\u202ed", ["a bcd"]),
    ],
)  # fmt: skip
def test_what_is_for_the_eye_is_not_spoken(text, heard):
    assert said(text) == heard


@pytest.mark.parametrize(
    ("text", "plain", "cues", "unknown"),
    [
        ("[joy] Hello", "Hello", [Tag(0, "happiness")], []),
        ("Hello, [face:surprise:0.7] you", "Hello, you", [Tag(7, "surprise", 0.7)], []),
        ("a [JOY:1] b [ face : joy : .25 ] c", "a b c", [Tag(2, "happiness", 1.0), Tag(4, "happiness", 0.25)], []),
        ("so[1] it [laughs] [joy:7] [face:x:y:z] is", "so it is", [], ["[1]", "[laughs]", "[joy:7]", "[face:x:y:z]"]),
        ("[] [[joy]] x", "   x", [Tag(1, "happiness")], ["[]"]),
        ("an [open one", "an  open one", [], []),
    ],
)
def test_words_in_brackets(text, plain, cues, unknown):
    found = split_tags(text, known)
    assert (found.text, list(found.tags), list(found.unknown)) == (plain, cues, unknown)


def test_cues_stand_at_their_words():
    script = Script.of("[joy] One two. [neutral] Three [surprise:0.2] four. [joy]", known)
    assert script.lines == (
        Line("One two.", (Tag(0, "happiness"),)),
        Line("Three four.", (Tag(0, "neutral"), Tag(6, "surprise", 0.2), Tag(11, "happiness"))),
    )


def test_a_long_sentence_comes_in_parts_that_end_at_its_pauses():
    text = "First this, then that, " * 40 + "done."
    parts = said(text)
    assert " ".join(parts) == text
    assert max(map(len, parts)) <= LONGEST_SENTENCE
    assert all(part.endswith((",", ".")) for part in parts)
    assert [len(part) for part in said("x" * 700)] == [300, 300, 100]


@pytest.mark.parametrize("text", ["", "  \n", "...", "?!", "😀", "[joy]", "```x```", "\ud800"])
def test_nothing_to_say_is_an_error(text):
    with pytest.raises(InvalidValueError, match="something that can be spoken"):
        Script.of(text, known)


def test_too_long_and_what_is_no_text():
    assert Script.of("a " * (MOST_CHARACTERS // 2))
    with pytest.raises(InvalidValueError, match="10000 characters, got 10001"):
        Script.of("a" * (MOST_CHARACTERS + 1))
    for wrong in (None, 3, b"bytes", ["a"]):
        with pytest.raises(InvalidValueError, match="text"):
            Script.of(wrong)


@given(st.text(max_size=200))
def test_sentences_are_the_text_s_own_in_their_order(text):
    plain = spoken(text)
    place = 0
    for sentence in sentences(plain):
        assert plain[sentence.start : sentence.start + len(sentence.text)] == sentence.text
        assert sentence.start >= place
        assert sentence.text == sentence.text.strip() != ""
        assert "\n" not in sentence.text
        place = sentence.start + len(sentence.text)
    heard = sum(map(str.isalnum, "".join(sentence.text for sentence in sentences(plain))))
    assert heard == sum(map(str.isalnum, plain)), "no word is lost"


@given(
    st.lists(
        st.sampled_from(["[joy]", "[x]", "[face:surprise:0.5]", "Word.", "word", "😀", "\n", "*", "["]), max_size=30
    )
)
def test_every_known_tag_becomes_one_cue_of_one_line(pieces):
    text = " ".join(pieces)
    expected = re.findall(r"\[(joy|face:surprise:0\.5)\]", text)
    try:
        script = Script.of(text, known)
    except InvalidValueError:
        return
    cues = [cue for line in script.lines for cue in line.tags]
    assert len(cues) == len(expected)
    for line in script.lines:
        assert [cue.at for cue in line.tags] == sorted(cue.at for cue in line.tags)
        assert all(0 <= cue.at <= len(line.text) for cue in line.tags)
        assert "[" not in line.text


@pytest.mark.parametrize(
    "piece", ["[", "](", "**", "http://", "<a", "`", "```", "\n- ", "_ ", ". ", "&", "[joy]", "。"]
)
def test_the_longest_text_of_anything_is_split(piece):
    text = (piece * MOST_CHARACTERS)[: MOST_CHARACTERS - 2] + " a"
    assert said(text)[-1].endswith("a")
