from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from xml.sax.saxutils import quoteattr

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.score import Cue
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import DataError
from agentface.io.emotion_vocabularies import BIG6, INTENSITY, published, shown_as
from agentface.io.emotionml import (
    LARGEST_FILE,
    MOST_EMOTIONS,
    NAMESPACE,
    load_emotionml,
    read_emotionml,
)

EXAMPLE = Path(__file__).parents[2] / "examples" / "moods.xml"
PUBLISHED = "http://www.w3.org/TR/emotion-voc/xml#"
SESSION = {"time_ref_uri": "#session", "time_ref_anchor_point": "end"}
FEAR = '<category name="fear"/>'


def document(*emotions, attributes=f'category-set="{BIG6}"'):
    body = "\n".join(emotions)
    return f'<emotionml version="1.0" xmlns="{NAMESPACE}" {attributes}>\n{body}\n</emotionml>'.encode()


def emotion(content=FEAR, **attributes):
    said = "".join(f" {name.replace('_', '-')}={quoteattr(str(value))}" for name, value in attributes.items())
    return f"<emotion{said}>{content}</emotion>"


def spans(*emotions):
    return [(cue.emotion, cue.start_s, cue.end_s) for cue in read_emotionml(document(*emotions)).cues]


def times(*emotions):
    return [span[1:] for span in spans(*emotions)]


def faults(data):
    with pytest.raises(DataError) as error:
        read_emotionml(data, "moods.xml")
    assert [fault.line or 0 for fault in error.value.faults] == sorted(fault.line or 0 for fault in error.value.faults)
    return [str(fault) for fault in error.value.faults]


def the_fault(*emotions):
    (fault,) = faults(document(*emotions))
    return fault


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


def test_a_document_without_emotions_is_a_score_without_cues():
    assert read_emotionml(document("<info>nothing yet</info>", attributes="")).cues == ()


def test_what_is_not_shown_is_left_out():
    content = (
        '<info xmlns:x="urn:x"><x:any><x:thing/></x:any></info>Oh!'
        '<category name="fear" value="0.5" confidence="0.1"/><dimension name="arousal" value="0.9"/>'
        '<appraisal name="suddenness"><trace freq="10Hz" samples="0 1"/></appraisal>'
        '<action-tendency name="approach"/><reference uri="file:face.avi#t=3,7"/>'
    )
    said = emotion(content, dimension_set="urn:x", expressed_through="face voice", version="1.0")
    assert read_emotionml(document(said)).cues == (Cue("fear", 0.0, 2.0, (0.5,)),)


@pytest.mark.parametrize(
    ("content", "level"),
    [
        (FEAR, 1.0),
        (f'{FEAR}<intensity value="0.4"/>', 0.4),
        (f'<dimension name="intensity" value="0.3"/>{FEAR}', 0.3),
        ('<category name="fear" value="0.2"/><intensity value="0.4"/>', 0.2),
        (f'{FEAR}<dimension name="arousal" value="0.3"/>', 1.0),
    ],
)
def test_a_category_without_a_value_takes_the_intensity(content, level):
    cues = read_emotionml(document(emotion(content, dimension_set=INTENSITY))).cues
    assert cues == (Cue("fear", 0.0, 2.0, (level,)),)


def test_an_intensity_of_another_vocabulary_is_none():
    said = emotion(f'<dimension name="intensity" value="0.3"/>{FEAR}', dimension_set="http://example.com/mine")
    assert read_emotionml(document(said)).cues == (Cue("fear", 0.0, 2.0),)


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


def test_a_vocabulary_of_the_document():
    vocabulary = '<vocabulary type="category" id="mine"><item name="fear"/><item name="boredom"/></vocabulary>'
    said = emotion(category_set="#mine")
    assert read_emotionml(document(vocabulary, said, attributes="")).cues == (Cue("fear", 0.0, 2.0),)
    bored = emotion('<category name="boredom"/>', category_set="#mine")
    assert "an emotion that the face shows" in faults(document(vocabulary, bored))[0]
    angry = emotion('<category name="anger"/>', category_set="#mine")
    assert "a name of the vocabulary" in faults(document(vocabulary, angry))[0]
    assert "the vocabulary big6" in the_fault(emotion(category_set="#other"))


@pytest.mark.parametrize(
    ("vocabulary", "name", "shown"),
    [
        ("everyday-categories", "angry", "anger"),
        ("everyday-categories", "afraid", "fear"),
        ("everyday-categories", "happy", "happiness"),
        ("everyday-categories", "sad", "sadness"),
        ("occ-categories", "joy", "happiness"),
        ("fsre-categories", "disgust", "disgust"),
        ("frijda-categories", "surprise", "surprise"),
        ("big6", "fear", "fear"),
    ],
)
def test_the_published_vocabularies_are_known(vocabulary, name, shown):
    said = emotion(f'<category name="{name}" value="0.5"/>', category_set=f"{PUBLISHED}{vocabulary}")
    assert read_emotionml(document(said, attributes="")).cues == (Cue(shown, 0.0, 2.0, (0.5,)),)


def test_every_published_name_is_shown_or_refused_as_one_that_is_not():
    for vocabulary, names in published().items():
        for name in names:
            data = document(emotion(f'<category name="{name}"/>', category_set=f"{PUBLISHED}{vocabulary}"))
            if shown_as(name):
                assert [cue.emotion for cue in read_emotionml(data).cues] == [shown_as(name)]
            else:
                assert "an emotion that the face shows" in faults(data)[0]


def test_neutral_in_a_vocabulary_of_the_document_lets_go():
    vocabulary = '<vocabulary type="category" id="mine"><item name="neutral"/><item name="angry"/></vocabulary>'
    angry = emotion('<category name="angry" value="0.8"/>', category_set="#mine", duration=4000)
    calm = emotion('<category name="neutral"/>', category_set="#mine", offset_to_start=1000, duration=1000)
    some = emotion('<category name="neutral" value="0.5"/>', category_set="#mine", offset_to_start=2000, duration=1000)
    score = read_emotionml(document(vocabulary, angry, calm, some, attributes=""))
    levels = [score.state(time)["anger"] for time in (0.5, 1.5, 2.5, 3.5)]
    assert levels == [0.8, 0.0, 0.5, 0.8]
    assert "neutral" in the_fault(emotion('<category name="neutral"/>')), "big6 has no such name"


def test_an_emotion_of_dimensions_beside_others_takes_its_time_and_is_noted():
    arousal = '<dimension name="arousal"><trace freq="10Hz" samples="0 0.5 1 0.5 0"/></dimension>'
    score = read_emotionml(document(emotion(), emotion(arousal, dimension_set="urn:x"), emotion()), "moods.xml")
    assert [(cue.start_s, cue.end_s) for cue in score.cues] == [(0.0, 2.0), (2.5, 4.5)]
    (note,) = map(str, score.notes)
    assert note.startswith("moods.xml:3: emotion 2: expected a category, got dimension")


def test_a_reference_out_of_the_document_is_noted():
    data = document(emotion(id="first"), emotion(time_ref_uri="#fisrt"), emotion(time_ref_uri="file:talk.avi"))
    (note,) = map(str, read_emotionml(data, "moods.xml").notes)
    assert note.startswith("moods.xml:3: emotion 2.time-ref-uri")
    assert "did you mean #first?" in note


@pytest.mark.parametrize(
    ("vocabulary", "messages"),
    [
        ('<vocabulary type="category" id="a"/>', ["at least one <item>"]),
        ('<vocabulary type="category"><item name="fear"/></vocabulary>', ["vocabulary.id: expected an id"]),
        ('<vocabulary id="a"><item name="fear"/></vocabulary>', ["vocabulary.type: expected one of category"]),
        (
            '<vocabulary type="somethingelse" id="1x"><item/><item name="anger"/><item name="anger"/></vocabulary>',
            ["got '1x'", "got 'somethingelse'", "a word, got nothing", "each name once, got 'anger' again"],
        ),
        (
            '<vocabulary type="dimension" id="a"><item name="x"/></vocabulary>' * 2,
            ["an id of its own, got 'a' again"],
        ),
        ('<vocabulary type="category" id="a"><item name="so so"/></vocabulary>', ["'so so'"]),
        ('<vocabulary type="category" id="a"><item nmae="fear" name="x"/></vocabulary>', ["got 'nmae'"]),
    ],
)
def test_what_a_vocabulary_lacks_is_told(vocabulary, messages):
    found = faults(document(vocabulary, emotion()))
    assert len(found) == len(messages)
    assert all(message in fault for message, fault in zip(messages, found, strict=True))


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


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ([{}, {}], [(0.0, 2.0), (2.0, 4.0)]),
        ([{"duration": 500}, {"duration": 0}, {}], [(0.0, 0.5), (0.5, 2.5), (2.5, 4.5)]),
        ([{"start": 1268647334000, "end": 1268647336500}, {}], [(0.0, 2.5), (2.5, 4.5)]),
        ([{"start": 9000}, {"start": 7000, "duration": 1000}], [(0.0, 1.0), (2.0, 4.0)]),
        ([{"start": 5000, "end": 5000}], [(0.0, 2.0)]),
        ([{"end": 5000, "duration": 1000}, {"end": 6000}], [(0.0, 1.0), (0.0, 2.0)]),
        ([{"start": 1, "end": 1001, "duration": 1000}], [(0.0, 1.0)]),
        ([{"offset_to_start": 3000}], [(3.0, 5.0)]),
        ([{"offset_to_start": -500}, {"offset_to_start": "+500"}], [(0.0, 2.0), (1.0, 3.0)]),
        ([{"id": "a", "duration": 700}, {"time_ref_uri": "#a", "offset_to_start": 100}], [(0.0, 0.7), (0.1, 2.1)]),
        ([{"id": "a"}, {"time_ref_uri": "#a", "time_ref_anchor_point": "end"}], [(0.0, 2.0), (2.0, 4.0)]),
        ([{"time_ref_uri": "#b", "offset_to_start": -400}, {"id": "b", "start": 8}], [(0.0, 2.0), (0.4, 2.4)]),
        ([{"time_ref_uri": "file:talk.avi", "offset_to_start": 1500}], [(1.5, 3.5)]),
        (
            [{"time_ref_uri": "#session", "time_ref_anchor_point": "end", "offset_to_start": -1000, "duration": 3000}],
            [(0.0, 3.0)],
        ),
        (
            [{}, {"time_ref_uri": "file:x", "time_ref_anchor_point": "end", "offset_to_start": 500}],
            [(0.0, 2.0), (0.5, 2.5)],
        ),
    ],
)
def test_times(said, expected):
    assert times(*(emotion(**attributes) for attributes in said)) == [pytest.approx(span) for span in sorted(expected)]


def test_a_long_chain_of_references():
    chain = [
        emotion(id=f"e{n}", duration=1, time_ref_uri=f"#e{n + 1}", time_ref_anchor_point="end") for n in range(3000)
    ]
    assert times(*chain, emotion(id="e3000", start=0, duration=1))[-1] == pytest.approx((3.0, 3.001))


@pytest.mark.parametrize(
    ("content", "attributes", "message"),
    [
        ('<category name="joy"/>', {}, "a name of the vocabulary, got 'joy' (did you mean happiness?)"),
        ('<category name="boredom"/>', {}, "known: anger, disgust, fear"),
        ("<category/>", {}, "a name of the vocabulary"),
        ('<category name="fear" value="1.5"/>', {}, "category fear.value: expected a number in 0..1, got '1.5'"),
        ('<category name="fear" value="nan"/>', {}, "'nan'"),
        ('<category name="fear" value="1_0"/>', {}, "'1_0'"),
        ('<category name="fear" confidence="2"/>', {}, "confidence"),
        (FEAR + FEAR, {}, "each category once"),
        (FEAR, {"category_set": "http://www.w3.org/TR/emotion-voc/xml#pad-dimensions"}, "the vocabulary big6"),
        (FEAR, {"category_set": f"{PUBLISHED}everyday-categories"}, "did you mean afraid"),
        ('<category name="bored"/>', {"category_set": f"{PUBLISHED}everyday-categories"}, "afraid, angry, happy, sad"),
        (FEAR + "<reference/>", {}, "reference.uri: expected what it refers to, got nothing"),
        (FEAR + '<reference uri="  "/>', {}, "reference.uri"),
        (FEAR + '<reference uri="#x" role="because"/>', {}, "expressedBy, experiencedBy, triggeredBy, targetedAt"),
        (FEAR + '<reference uri="#x" url="y"/>', {}, "no such attribute, got 'url'"),
        (FEAR, {"id": "1x"}, "id: expected an id that begins with a letter, got '1x'"),
        ('<dimension name="arousal" value="1"/>', {}, "a category, got dimension"),
        ("", {}, "a category, got none"),
        ('<category name="fear"><trace freq="10" samples="0"/></category>', {}, "like 10Hz, got '10'"),
        ('<category name="fear"><trace freq="0Hz" samples="0"/></category>', {}, "freq"),
        ('<category name="fear"><trace samples="0"/></category>', {}, "freq"),
        ('<category name="fear"><trace freq="1e5Hz" samples="0"/></category>', {}, "freq"),
        ('<category name="fear"><trace freq="99999Hz" samples="0"/></category>', {}, "freq"),
        ('<category name="fear"><trace freq="1Hz" samples=" "/></category>', {}, "at least one number"),
        ('<category name="fear"><trace freq="1Hz" samples="0 -1"/></category>', {}, "'-1'"),
        ('<category name="fear" value="1"><trace freq="1Hz" samples="0"/></category>', {}, "a value or one trace"),
        (FEAR + "<intensity/>", {}, "a value or a trace, got neither"),
        (FEAR + '<intensity value="1"/><intensity value="1"/>', {}, "one intensity"),
        (FEAR + "<mood/>", {}, "no such element, got <mood>"),
        (FEAR + '<x:category xmlns:x="urn:x" name="fear"/>', {}, "<category> of urn:x"),
        (FEAR, {"strat": 5}, "no such attribute, got 'strat' (did you mean start?)"),
        (FEAR, {"version": "2.0"}, "version: expected 1.0, got 2.0"),
        (FEAR, {"start": -1}, "start: expected a whole number of milliseconds, zero or more"),
        (FEAR, {"start": "1.5"}, "'1.5'"),
        (FEAR, {"duration": "9" * 5000}, "duration"),
        (FEAR, {"start": 5, "end": 4}, "start 5, end 4"),
        (FEAR, {"start": 5, "end": 9, "duration": 5}, "duration 5"),
        (FEAR, {"start": 5, "offset_to_start": 4}, "absolute or relative"),
        (FEAR, {"time_ref_anchor_point": "middle"}, "start or end"),
        (FEAR, {"id": "me", "time_ref_uri": "#me"}, "a circle"),
        (FEAR, {"duration": 3_600_001}, "within 3600 s"),
    ],
)  # fmt: skip
def test_a_fault_says_where_and_what(content, attributes, message):
    fault = the_fault("", emotion(content, **attributes))
    assert fault.startswith("moods.xml:3: emotion 1"), "the root, an empty line, the emotion"
    assert message in fault


def test_circles_and_names_of_more_than_one():
    circle = [emotion(id=name, time_ref_uri=f"#{to}") for name, to in ("ab", "bc", "ca")]
    assert "a circle" in the_fault(*circle)
    assert "an id of its own" in the_fault(emotion(id="a"), emotion(id="a"))


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


@given(st.integers(0, 2000), st.integers(0, 30), st.binary(max_size=10))
def test_a_damaged_document_is_a_score_or_faults(at, length, instead):
    data = EXAMPLE.read_bytes()
    with suppress(DataError):
        assert read_emotionml(data[:at] + instead + data[at + length :]).changes


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
