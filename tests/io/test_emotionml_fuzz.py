from __future__ import annotations

import tracemalloc
from pathlib import Path
from xml.sax.saxutils import quoteattr

import pytest
from emotionml_documents import PUBLISHED, document, emotion
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.emotion.vocabularies import published
from agentface.errors import DataError
from agentface.io import markup
from agentface.io.emotionml import read_emotionml
from agentface.io.emotionml_grammar import _ATTRIBUTES

EXAMPLE = Path(__file__).parents[2] / "examples" / "moods.xml"


def read(data):
    """The score of some bytes, or None and faults that are few, short, and name the file."""
    try:
        return read_emotionml(data, "moods.xml")
    except DataError as error:
        told = error.faults
    assert len(told) in range(1, 1001)
    assert all(str(fault).startswith("moods.xml") for fault in told)
    assert max(len(str(fault)) for fault in told) < 6000
    return None


@given(st.integers(0, 2000), st.integers(0, 30), st.binary(max_size=10))
def test_a_damaged_document_is_a_score_or_faults(at, length, instead):
    data = EXAMPLE.read_bytes()
    score = read(data[:at] + instead + data[at + length :])
    assert score is None or score.changes


@given(st.integers(0, 2000))
def test_a_document_that_ends_early_is_faults(at):
    data = EXAMPLE.read_bytes().rstrip()
    assert (read(data[:at]) is None) == (at < len(data))


@given(st.binary(max_size=300))
def test_any_bytes_are_faults(data):
    assert read(data) is None


NAMES = st.sampled_from(
    (
        *("emotion", "emotionml", "category", "dimension", "appraisal", "action-tendency", "intensity", "trace"),
        *("reference", "vocabulary", "item", "info", "x"),
    )
)
ATTRIBUTES = st.dictionaries(
    st.sampled_from(sorted({name for names in _ATTRIBUTES.values() for name in names})),
    st.one_of(
        st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs"]), max_size=8),
        st.sampled_from(
            ["1.0", "0.5", "10Hz", "0 1", "fear", "power", "pleasure", "approach", "#a", "a", "category", "-1"]
        ),
        st.sampled_from([f"{PUBLISHED}{name}" for name in published()]),
        st.integers().map(str),
        st.floats().map(str),
    ),
    max_size=5,
)


def element(name, attributes, children):
    said = "".join(f" {key}={quoteattr(value)}" for key, value in attributes.items())
    return f"<{name}{said}>{''.join(children)}</{name}>"


ELEMENTS = st.recursive(
    st.builds(element, NAMES, ATTRIBUTES, st.just([])),
    lambda inner: st.builds(element, NAMES, ATTRIBUTES, st.lists(inner, max_size=4)),
    max_leaves=12,
)


@given(st.lists(ELEMENTS, max_size=4))
def test_any_elements_are_a_score_or_faults(elements):
    score = read(document(*elements))
    assert score is None or (score.changes and score.length_s > 0.0)


def item(number):
    return f'<item name="i{number}"/>'


UNKNOWN = '<emotion category-set="#a"><category name="x"/></emotion>'
NONSENSE = [
    document(*['<emotion/><vocabulary type="category" id="a"/>'] * 1000),
    document(*["<emotoin/>"] * 5000),
    document("<emotion " + " ".join(f'a{number}="{number}"' for number in range(5000)) + "/>"),
    document('<vocabulary type="category" id="a">', *map(item, range(5000)), "</vocabulary>", *[UNKNOWN] * 1000),
    document(emotion(f'<category name="{"fear" * 20_000}"/>')),
    document(emotion(f'<category name="fear"><trace freq="1Hz" samples="{"2 " * 50_000}"/></category>')),
    b"<" * 100_000,
    b"\0" * 100_000,
    b'<a b="' + b"&#65;" * 20_000 + b'"/>',
]


@pytest.mark.parametrize("data", NONSENSE, ids=range(len(NONSENSE)))
def test_what_large_nonsense_takes_is_bounded_by_its_size(data):
    assert memory(read, data) < 60 * len(data)


def memory(function, data):
    """The most bytes that a call takes at a time, beyond what is there already."""
    function(data)
    tracemalloc.start()
    assert (function(data) is None) == (data in NONSENSE)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return peak


SLOW = f'<dimension name="pleasure"><trace freq="0.01Hz" samples="{"0 1 " * 500}"/></dimension>'
FAST = '<dimension name="arousal"><trace freq="9000Hz" samples="0 1"/></dimension>'


@pytest.mark.parametrize(
    "said",
    [
        emotion(f'<category name="fear"><trace freq="1000Hz" samples="{"0 1 " * 20_000}"/></category>'),
        emotion(SLOW + FAST, dimension_set=f"{PUBLISHED}pad-dimensions"),
    ],
    ids=["trace", "traces"],
)
def test_what_a_large_document_takes_is_bounded_by_its_size(said):
    block = 8 * 2**20  # of mixtures at a time
    assert memory(read, document(said)) < block + 200 * len(said)


def test_elements_are_counted(monkeypatch):
    monkeypatch.setattr(markup, "_MOST_ELEMENTS", 10)
    assert read(document(*["<a/>"] * 9)) is None
    with pytest.raises(DataError, match="expected at most 10 elements"):
        read_emotionml(document(*["<a/>"] * 10), "moods.xml")


FRACTION = st.floats(0.0, 1.0).map(repr)
TRACES = st.builds(
    lambda rate, samples: f'<trace freq="{rate:.3f}Hz" samples="{" ".join(samples)}"/>',
    st.floats(0.1, 100.0),
    st.lists(FRACTION, min_size=1, max_size=8),
)
MILLISECONDS = st.integers(0, 20_000)
TIMES = st.one_of(
    st.just({}),
    st.builds(lambda start, length: {"start": start, "end": start + length}, MILLISECONDS, MILLISECONDS),
    st.fixed_dictionaries({}, optional={"start": MILLISECONDS, "duration": MILLISECONDS}),
    st.fixed_dictionaries({"offset_to_start": st.integers(-20_000, 20_000)}, optional={"duration": MILLISECONDS}),
    st.fixed_dictionaries(
        {"time_ref_uri": st.just("#first")},
        optional={"time_ref_anchor_point": st.sampled_from(["start", "end"]), "duration": MILLISECONDS},
    ),
)


@st.composite
def emotions(draw):
    content = draw(st.one_of(st.just(""), FRACTION.map('<intensity value="{}"/>'.format)))
    for name in draw(st.lists(st.sampled_from(EMOTIONS), min_size=1, max_size=4, unique=True)):
        value = draw(
            st.one_of(st.just("/>"), FRACTION.map(' value="{}"/>'.format), TRACES.map(">{}</category>".format))
        )
        content += f'<category name="{name}"{value}'
    return emotion(content, **draw(TIMES))


@given(st.lists(emotions(), max_size=6), st.lists(st.floats(0.0, 1.0), min_size=1, max_size=10))
def test_any_valid_document_gives_states_and_changes_in_order(said, parts):
    score = read_emotionml(document(emotion(id="first"), *said))
    told = [change.time_s for change in score.changes]
    assert told == sorted(set(told))
    assert told[0] == 0.0
    assert score.state(score.duration_s) == score.changes[-1].state == EmotionState()
    for part in parts:
        values = score.state(part * score.length_s).array
        assert ((values >= 0.0) & (values <= 1.0)).all()
    assert min(cue.start_s for cue in score.cues) == 0.0
