from __future__ import annotations

from pathlib import Path

import pytest
from emotionml_documents import FEAR, PUBLISHED, document, emotion, faults

from agentface.emotion.score import Cue
from agentface.emotion.state import EmotionState
from agentface.errors import DataError
from agentface.io.emotion_vocabularies import BIG6
from agentface.io.emotionml import LARGEST_FILE, MOST_EMOTIONS, load_emotionml, read_emotionml
from agentface.io.emotionml_grammar import NAMESPACE

EXAMPLE = Path(__file__).parents[2] / "examples" / "moods.xml"
INTENSITY = f"{PUBLISHED}intensity-dimension"


def test_the_example_is_what_it_says():
    score = load_emotionml(EXAMPLE)
    assert score.state(0.0) == EmotionState.of(happiness=0.4), "half a second of 1970 is where it begins"
    assert score.state(1.5) == EmotionState.of(surprise=0.8, happiness=0.3)
    assert score.state(2.79 + 0.6)["fear"] == pytest.approx(0.7)
    assert score.state(score.duration_s - 0.1) == EmotionState.of(happiness=0.9)
    assert score.duration_s == pytest.approx(2.79 + 1.6 + 1.2 + 1.5 + 2.0)


def test_several_categories_are_a_mixture():
    score = read_emotionml(
        document(emotion('<category name="sadness" value="0.3"/><category name=" anger " value=" 8e-1 "/>'))
    )
    assert score.state(1.0) == EmotionState.of(sadness=0.3, anger=0.8)
    assert score.duration_s == 2.0


def test_an_emotion_may_be_the_root():
    data = f'<e:emotion xmlns:e="{NAMESPACE}" category-set="{BIG6}"><e:category name="fear"/></e:emotion>'
    assert read_emotionml(data.encode()).cues == (Cue("fear", 0.0, 2.0),)


@pytest.mark.parametrize(
    ("content", "level"),
    [
        (FEAR, 1.0),
        (f'{FEAR}<intensity value="0.4"/>', 0.4),
        (f'<dimension name="intensity" value="0.3"/>{FEAR}', 0.3),
        ('<category name="fear" value="0.2"/><intensity value="0.4"/>', 0.2),
    ],
)
def test_a_category_without_a_value_takes_the_intensity(content, level):
    cues = read_emotionml(document(emotion(content, dimension_set=INTENSITY))).cues
    assert cues == (Cue("fear", 0.0, 2.0, (level,)),)


def test_a_trace_lasts_as_long_as_its_samples():
    trace = '<category name="fear"><trace freq="10.5 Hz" samples="0.1 0.1\n0.15  .2 1"/></category>'
    (cue,) = read_emotionml(document(emotion(trace))).cues
    assert (cue.samples, cue.rate_hz, cue.start_s) == ((0.1, 0.1, 0.15, 0.2, 1.0), 10.5, 0.0)
    assert cue.end_s == pytest.approx(5 / 10.5)
    (cue,) = read_emotionml(document(emotion(trace, duration=3000))).cues
    assert cue.end_s == 3.0
    both = f'{FEAR}<category name="anger" value="1"/><intensity><trace freq="2Hz" samples="0 1 0"/></intensity>'
    anger, fear = read_emotionml(document(emotion(both))).cues
    assert (fear.samples, fear.rate_hz, fear.end_s) == ((0.0, 1.0, 0.0), 2.0, 1.5)
    assert (anger.samples, anger.end_s) == ((1.0,), 1.5)


def test_neutral_in_a_vocabulary_of_the_document_lets_go():
    vocabulary = '<vocabulary type="category" id="mine"><item name="neutral"/><item name="angry"/></vocabulary>'
    angry = emotion('<category name="angry" value="0.8"/>', category_set="#mine", duration=4000)
    calm = emotion('<category name="neutral"/>', category_set="#mine", offset_to_start=1000, duration=1000)
    some = emotion('<category name="neutral" value="0.5"/>', category_set="#mine", offset_to_start=2000, duration=1000)
    score = read_emotionml(document(vocabulary, angry, calm, some, attributes=""))
    levels = [score.state(time)["anger"] for time in (0.5, 1.5, 2.5, 3.5)]
    assert levels == [0.8, 0.0, 0.5, 0.8]


@pytest.mark.parametrize(
    ("value", "level"), [("1.0000001", 1.0), ("-1e-7", 0.0), ("1.000002", None), ("-0.00001", None)]
)
def test_values_that_rounding_puts_outside_are_taken(value, level):
    data = document(emotion(f'<category name="fear" value="{value}"/>'))
    if level is None:
        assert "0..1" in faults(data)[0]
    else:
        assert read_emotionml(data).cues == (Cue("fear", 0.0, 2.0, (level,)),)


def test_what_other_programs_write_beside_it_is_read():
    attributes = (
        f'category-set="{BIG6}" xml:lang="de" xml:base="http://example.org/"'
        ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
        ' xsi:schemaLocation="http://www.w3.org/2009/10/emotionml http://www.w3.org/TR/emotionml/emotionml.xsd"'
    )
    said = f'<emotion xml:lang="de">wütend {FEAR}</emotion>'
    assert read_emotionml(document(said, attributes=attributes)).cues == (Cue("fear", 0.0, 2.0),)


def test_all_faults_at_once():
    data = document(emotion('<category name="joy" value="2"/>'), emotion(start="soon"), emotion(id="2"), "<emotoin/>")
    found = faults(data)
    assert [fault.split(": ")[0] for fault in found] == [f"moods.xml:{line}" for line in (2, 2, 3, 4, 5)]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"", "moods.xml:1: expected well-formed XML"),
        (b"not XML", "well-formed XML"),
        (document(emotion())[:-5], "moods.xml:3: expected well-formed XML"),
        (document("<emotion>"), "mismatched tag"),
        (b"<emotion/>", "got <emotion> of no namespace"),
        (f'<emotions xmlns="{NAMESPACE}"/>'.encode(), "got <emotions>"),
        (b'<emotionml version="1.0" xmlns="http://www.w3.org/2005/Incubator/emotion"/>', "2005/Incubator"),
        (f'<emotionml xmlns="{NAMESPACE}"/>'.encode(), "version: expected 1.0, got nothing"),
        (b"<a>" * 200_000, "at most 100 deep"),
        (b" " * (LARGEST_FILE + 1), f"at most {LARGEST_FILE} bytes"),
        (document(*["<emotion/>"] * (MOST_EMOTIONS + 1)), f"at most {MOST_EMOTIONS} emotions"),
        (b'<?xml version="1.0" encoding="cp932"?><a/>', "UTF-8"),
        (b'<?xml version="1.0" encoding="klingon"?><a/>', "unknown encoding"),
        (b"\xff\xfe\x00\xd8<\x00", "XML"),
    ],
)
def test_what_is_no_document(data, message):
    (fault,) = faults(data)
    assert message in fault


@pytest.mark.parametrize(
    "head",
    [
        '<!DOCTYPE emotionml [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;&a;&a;&a;&a;">]>',
        '<!DOCTYPE emotionml SYSTEM "file:///etc/passwd">',
        '<!DOCTYPE emotionml [<!ENTITY x SYSTEM "file:///etc/passwd">]>',
        "<!DOCTYPE emotionml>",
    ],
)
def test_a_document_type_is_refused(head):
    assert faults(head.encode() + b"\n" + document("&b;")) == [
        "moods.xml:1: expected no document type and no entities, got one; leave <!DOCTYPE ...> and <!ENTITY ...> out"
    ]


def test_other_encodings_of_the_same():
    text = '<?xml version="1.0" encoding="{}"?>' + document("<info>für</info>", emotion()).decode()
    for encoding in ("utf-8", "utf-16", "iso-8859-1"):
        assert read_emotionml(text.format(encoding).encode(encoding)).cues == (Cue("fear", 0.0, 2.0),)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(DataError, match="a readable file"):
        load_emotionml(tmp_path / "none.xml")
