"""The assertions of the implementation report of EmotionML 1.0, by their numbers: what is refused, what may be written.

Not here are 116, 119, 122, 160, 163, 166 and 169, anyURI as in 113, and 416, a string, which cannot be broken.
"""

from __future__ import annotations

import pytest
from emotionml_documents import FEAR, PUBLISHED, document, emotion, faults

from agentface.errors import DataError
from agentface.io.emotion_vocabularies import BIG6
from agentface.io.emotionml import read_emotionml
from agentface.io.emotionml_grammar import NAMESPACE

PAD, SCHERER = f"{PUBLISHED}pad-dimensions", f"{PUBLISHED}scherer-appraisals"
TENDENCIES = f"{PUBLISHED}frijda-action-tendencies"
SETS = {"dimension_set": PAD, "appraisal_set": SCHERER, "action_tendency_set": TENDENCIES}
KINDS = {"dimension": "pleasure", "appraisal": "power", "action-tendency": "approach"}
ONE_HERTZ = '<trace freq="1Hz" samples="0"/>'
ITEM = '<item name="fear"/>'
MINE = f'<vocabulary type="category" id="mine">{ITEM}</vocabulary>'


def root(attributes, content=""):
    return f"<emotionml {attributes}>{content}</emotionml>".encode()


def one(content, **attributes):
    """A document whose emotion stands on line 3."""
    return document("", emotion(content, **{**SETS, **attributes}))


def kinds(template, number):
    """A case for each kind of descriptor but categories; their numbers are ten apart."""
    return [
        (number + 10 * place, template.replace("KIND", kind).replace("NAME", name))
        for place, (kind, name) in enumerate(KINDS.items())
    ]


REFUSED = [
    (101, f'<info xmlns="{NAMESPACE}"/>'.encode(), 1, "<emotionml> or <emotion>"),
    (102, root('version="1.0"'), 1, "of no namespace"),
    (105, document("<info/>", "<info/>"), 3, "one <info>"),
    (110, root(f'xmlns="{NAMESPACE}"'), 1, "version: expected 1.0, got nothing"),
    (111, root(f'xmlns="{NAMESPACE}" version="1.1"'), 1, "version: expected 1.0, got 1.1"),
    (113, root(f'xmlns="{NAMESPACE}" version="1.0" category-set=";:"'), 1, "a URI"),
    (114, document(attributes=f'category-set="{PAD}"'), 1, "a vocabulary of type category"),
    (114, document(attributes='category-set="#none"'), 1, "big6, everyday-categories"),
    (114, document(attributes=f'category-set="{PUBLISHED}big7"'), 1, "did you mean"),
    (117, document(attributes=f'dimension-set="{BIG6}"'), 1, "a vocabulary of type dimension"),
    (120, document(attributes=f'appraisal-set="{PAD}"'), 1, "a vocabulary of type appraisal"),
    (123, document(attributes=f'action-tendency-set="{PAD}"'), 1, "a vocabulary of type action-tendency"),
    (155, one(FEAR + "<info/><info/>"), 3, "one <info>"),
    (156, one(""), 3, "at least one of category, dimension, appraisal, action-tendency"),
    (156, one('<intensity value="1"/>'), 3, "at least one of category"),
    (161, one(FEAR, category_set=PAD), 3, "a vocabulary of type category"),
    (161, document(MINE, emotion(FEAR, dimension_set="#mine")), 3, "a vocabulary of type dimension"),
    (164, one(FEAR, dimension_set=BIG6), 3, "a vocabulary of type dimension"),
    (167, one(FEAR, appraisal_set=PAD), 3, "a vocabulary of type appraisal"),
    (170, one(FEAR, action_tendency_set=PAD), 3, "a vocabulary of type action-tendency"),
    (172, one(FEAR, version="2.0"), 3, "version: expected 1.0, got 2.0"),
    (174, one(FEAR, id="1x"), 3, "an id that begins with a letter"),
    (174, one(FEAR, id="a:b"), 3, "an id that begins with a letter"),
    (174, document(emotion(id="a"), emotion(id="a")), 3, "an id of its own"),
    (174, document(MINE, emotion(id="mine")), 3, "an id of its own"),
    (210, document("", emotion(), attributes=""), 3, "the attribute category-set"),
    (211, one("<category/>"), 3, "a name, got nothing"),
    (212, one('<category name="joy"/>'), 3, "did you mean happiness?"),
    (212, one('<category name="afraid"/>', category_set=BIG6), 3, "did you mean fear?"),
    (212, document(MINE, emotion('<category name="anger"/>', category_set="#mine")), 3, "a name of the vocabulary"),
    (213, one(FEAR + FEAR), 3, "each category once"),
    (216, one('<category name="fear" value="1"><trace freq="1Hz" samples="0"/></category>'), 3, "a value or one trace"),
    *((n, document("", emotion(c)), 3, "-set of <emotion>") for n, c in kinds('<KIND name="NAME" value="1"/>', 220)),
    *((n, one(content), 3, "a name, got nothing") for n, content in kinds('<KIND value="1"/>', 221)),
    *((n, one(content), 3, "a name of the vocabulary") for n, content in kinds('<KIND name="x" value="1"/>', 222)),
    *((n, one(content), 3, "once in an emotion") for n, content in kinds('<KIND name="NAME" value="1"/>' * 2, 223)),
    (224, one('<dimension name="pleasure"/>'), 3, "a value or a trace, got neither"),
    *(
        (number, one(content), 3, "a value or one trace")
        for number, content in kinds('<KIND name="NAME" value="1"><trace freq="1Hz" samples="0"/></KIND>', 226)
    ),
    (236, one(f'<appraisal name="power">{2 * ONE_HERTZ}</appraisal>'), 3, "one trace"),
    (300, one('<category name="fear" confidence="1.1"/>'), 3, "confidence: expected a number in 0..1"),
    (300, one('<category name="fear" confidence="high"/>'), 3, "'high'"),
    (301, one(FEAR, expressed_through=""), 3, "expressed-through"),
    (301, one(FEAR, expressed_through="face voice!"), 3, "expressed-through"),
    (304, one(FEAR + f"<info>{FEAR}</info>"), 3, "elements of other namespaces, got <category>"),
    (304, one(FEAR + f'<info><x:a xmlns:x="urn:x">{FEAR}</x:a></info>'), 3, "elements of other namespaces"),
    (306, document('<info id="1"/>'), 2, "emotionml.info.id"),
    (410, one(FEAR + "<reference/>"), 3, "reference.uri: expected what it refers to"),
    (411, one(FEAR + '<reference uri="a#b#c"/>'), 3, "a URI"),
    (414, one(FEAR + '<reference uri="#x" role="because"/>'), 3, "expressedBy, experiencedBy, triggeredBy, targetedAt"),
    (417, one(FEAR + '<reference uri="#x" media-type="video"/>'), 3, "a MIME type"),
    (420, one(FEAR, start=-1), 3, "start: expected a whole number of milliseconds, zero or more"),
    (420, one(FEAR, start="1.5"), 3, "'1.5'"),
    (421, one(FEAR, end="soon"), 3, "end: expected a whole number"),
    (422, one(FEAR, duration="1s"), 3, "duration: expected a whole number"),
    (423, one(FEAR, time_ref_uri="1:2"), 3, "a URI"),
    (424, one(FEAR, time_ref_anchor_point="middle"), 3, "start or end"),
    (425, one(FEAR, offset_to_start="1.0"), 3, "offset-to-start: expected a whole number"),
    (500, one('<category name="fear" value="1.5"/>'), 3, "category fear.value: expected a number in 0..1, got '1.5'"),
    (500, one('<category name="fear" value="nan"/>'), 3, "'nan'"),
    (500, one('<category name="fear" value="1_0"/>'), 3, "'1_0'"),
    (500, one('<category name="fear" value=""/>'), 3, "value"),
    (500, one('<dimension name="arousal" value="-0.1"/>'), 3, "dimension arousal.value"),
    (501, one('<category name="fear"><trace samples="0"/></category>'), 3, "freq"),
    (502, one('<category name="fear"><trace freq="10" samples="0"/></category>'), 3, "like 10Hz, got '10'"),
    (502, one('<category name="fear"><trace freq="0Hz" samples="0"/></category>'), 3, "freq"),
    (502, one('<category name="fear"><trace freq="-1Hz" samples="0"/></category>'), 3, "freq"),
    (502, one('<category name="fear"><trace freq="1e2Hz" samples="0"/></category>'), 3, "freq"),
    (503, one('<category name="fear"><trace freq="1Hz"/></category>'), 3, "at least one number"),
    (504, one('<category name="fear"><trace freq="1Hz" samples=" "/></category>'), 3, "at least one number"),
    (504, one('<category name="fear"><trace freq="1Hz" samples="0 -1"/></category>'), 3, "'-1'"),
    (504, one('<category name="fear"><trace freq="1Hz" samples="0,1"/></category>'), 3, "'0,1'"),
    (600, document('<vocabulary type="category" id="a"/>'), 2, "at least one <item>"),
    (601, document(f'<vocabulary type="category" id="a"><info/>{ITEM}<info/></vocabulary>'), 2, "one <info>"),
    (602, document(f'<vocabulary id="a">{ITEM}</vocabulary>'), 2, "type: expected one of category"),
    (603, document(f'<vocabulary type="mood" id="a">{ITEM}</vocabulary>'), 2, "got 'mood'"),
    (604, document(f'<vocabulary type="category">{ITEM}</vocabulary>'), 2, "vocabulary.id: expected an id"),
    (605, document(f'<vocabulary type="category" id="1">{ITEM}</vocabulary>'), 2, "got '1'"),
    (605, document(MINE, MINE), 3, "an id of its own"),
    (606, document(MINE.replace("/></v", "><info/><info/></item></v")), 2, "one <info>"),
    (607, document('<vocabulary type="category" id="a"><item/></vocabulary>'), 2, "a word, got nothing"),
    (607, document('<vocabulary type="category" id="a"><item name="so so"/></vocabulary>'), 2, "'so so'"),
    (608, document(f'<vocabulary type="category" id="a">{ITEM}{ITEM}</vocabulary>'), 2, "each name once"),
    (700, one(FEAR + '<x:category xmlns:x="urn:x" name="fear"/>'), 3, "<category> of urn:x"),
    (700, document('<x:a xmlns:x="urn:x"/>'), 2, "<a> of urn:x"),
    ("schema", one(FEAR + "<mood/>"), 3, "no such element, got <mood>"),
    ("schema", one(FEAR, strat=5), 3, "no such attribute, got 'strat' (did you mean start?)"),
    ("schema", one(FEAR + '<reference uri="#x" url="y"/>'), 3, "no such attribute, got 'url'"),
    ("schema", document("<emotoin/>"), 2, "did you mean emotion?"),
    ("times", one(FEAR, start=5, end=4), 3, "start 5, end 4"),
    ("times", one(FEAR, start=5, end=9, duration=5), 3, "duration 5"),
    ("drafts", one(FEAR + "<intensity/>"), 3, "a value or a trace, got neither"),
    ("drafts", one(FEAR + '<intensity value="1"/><intensity value="1"/>'), 3, "one intensity"),
]  # fmt: skip


@pytest.mark.parametrize(
    ("data", "line", "message"), [case[1:] for case in REFUSED], ids=[str(case[0]) for case in REFUSED]
)
def test_what_the_standard_forbids_is_told_with_its_line(data, line, message):
    (fault,) = faults(data)
    assert fault.startswith(f"moods.xml:{line}: ")
    assert message in fault


TRACE = '<trace freq="2.5 Hz" samples="0 1e-1 .5\n1."/>'
PLAYED = [
    (103, document(emotion(), emotion())),
    (103, document()),
    (104, document(MINE, MINE.replace("mine", "too"), emotion(category_set="#mine"))),
    (105, document("<info>text</info>", emotion())),
    (112, document(emotion(), attributes=f'category-set=" {BIG6} "')),
    (115, document(emotion('<dimension name="pleasure" value="1"/>'), attributes=f'dimension-set="{PAD}"')),
    (118, document(emotion('<appraisal name="power"/>'), attributes=f'appraisal-set="{SCHERER}"')),
    (121, document(emotion('<action-tendency name="approach"/>'), attributes=f'action-tendency-set="{TENDENCIES}"')),
    (124, document("some text", emotion(), "<!-- a comment -->", "more")),
    (150, one(FEAR + '<category name="anger"/>')),
    (151, one('<dimension name="pleasure" value="0"/><dimension name="arousal" value="1"/>')),
    (152, one('<appraisal name="power"/><appraisal name="control"/>')),
    (153, one('<action-tendency name="approach"/><action-tendency name="attending"/>')),
    (154, one(FEAR + '<reference uri="#a"/><reference uri="#b"/>')),
    (157, one(f'<reference uri="#a"/><action-tendency name="approach"/><info/>{FEAR}<appraisal name="power"/>')),
    (158, one(f'{FEAR}<dimension name="pleasure" value="0"/><appraisal name="power"/>')),
    (159, document(emotion(category_set=f"{PUBLISHED}big6"), attributes="")),
    (171, one(FEAR, version="1.0")),
    (173, one(FEAR, id="_a-1.b")),
    (175, one(FEAR, start=0, end="+5", duration=5)),
    (177, one(FEAR, duration="-0")),
    (178, one(FEAR, time_ref_uri="file:film.mp4", time_ref_anchor_point="end", offset_to_start=-5)),
    (181, one(FEAR, expressed_through="face  voice x:y")),
    (182, one(f"Oh! {FEAR} No!")),
    (214, one('<category name="fear" value="1.0E0"/>')),
    (215, one(f'<category name="fear">{TRACE}</category>')),
    (217, one('<category name="fear" confidence="0.5"/>')),
    (222, document(emotion('<category name="angry"/>', category_set=f"{PUBLISHED}everyday-categories"))),
    (225, one('<dimension name="pleasure" value="0" confidence="0"/>')),
    (245, one(f'<action-tendency name="approach">{TRACE}</action-tendency>')),
    (302, one(f'{FEAR}<info id="i"><x:a xmlns:x="urn:x"><x:b/></x:a></info>')),
    (303, one(f"{FEAR}<info>any text</info>")),
    (412, one(f'{FEAR}<reference uri="film.mp4#t=3,7" role="triggeredBy" media-type="video/mp4; codecs=avc1"/>')),
    (412, one(f'{FEAR}<reference uri="" role="targetedAt"/><reference uri="https://é.example/a b"/>')),
    (502, one('<category name="fear"><trace freq="00010.Hz" samples="0"/></category>')),
    (502, one(f'<category name="fear"><trace freq="{"9" * 400}Hz" samples="0 1"/></category>')),
    (502, one('<category name="fear"><trace freq="99999Hz" samples="0 1 0"/></category>')),
    (502, one(f'<dimension name="arousal"><trace freq="0.{"0" * 200}1Hz" samples="0 1 0"/></dimension>')),
    (601, document(f'<vocabulary type="dimension" id="a"><info/>{ITEM}</vocabulary>')),
    (606, document('<vocabulary type="appraisal" id="a"><item name="b.c:d-1"><info/></item></vocabulary>')),
]


@pytest.mark.untraced
@pytest.mark.parametrize("data", [case[1] for case in PLAYED], ids=[str(case[0]) for case in PLAYED])
def test_what_the_standard_allows_is_played(data):
    score = read_emotionml(data)
    assert score.length_s > 0.0
    assert score.changes


INTENSITY = f"{PUBLISHED}intensity-dimension"


def own(kind, name):
    """A document with a vocabulary of one word, and an emotion of it on line 3."""
    vocabulary = f'<vocabulary type="{kind}" id="m"><item name="{name}"/></vocabulary>'
    return document(vocabulary, emotion(f'<{kind} name="{name}" value="1"/>', **{f"{kind}_set": "#m"}))


NOTED = [
    (document(), 1, "at least one emotion, got none (the face stays neutral)"),
    (one('<category name="x"/>', category_set="http://example.org/v#a"), 3, "a vocabulary of the W3C or of the"),
    (own("category", "boredom"), 3, "an emotion that the face shows, got 'boredom'"),
    (own("dimension", "age"), 3, "a name that says something to the face, got 'age'"),
    (one('<dimension name="intensity" value="1"/>', dimension_set=INTENSITY), 3, "an intensity alone"),
    (one('<appraisal name="relevance-person"/>'), 3, "what the face shows, got 'relevance-person'"),
    (one(FEAR + '<intensity value="1"/>'), 3, "no <intensity>, which is of earlier drafts"),
    (one(FEAR, time_ref_uri="#none"), 3, "the id of an emotion, got '#none'"),
    (document(emotion(id="first"), emotion(time_ref_uri="#fisrt")), 3, "did you mean #first?"),
    (one(FEAR, start=5, offset_to_start=4), 3, "absolute or relative times"),
    (one(FEAR, id="me", time_ref_uri="#me"), 3, "a circle"),
    (one(FEAR, duration=3_600_001), 3, "within 3600 s"),
    (one(FEAR, duration="9" * 5000), 3, "within 3600 s"),
]  # fmt: skip


@pytest.mark.parametrize(("data", "line", "message"), NOTED)
def test_what_is_not_shown_is_noted_and_with_strict_a_fault(data, line, message):
    score = read_emotionml(data, "moods.xml")
    told = [str(note) for note in score.notes]
    assert any(note.startswith(f"moods.xml:{line}: ") and message in note for note in told), told
    assert score.length_s > 0.0
    with pytest.raises(DataError) as error:
        read_emotionml(data, "moods.xml", strict=True)
    assert error.value.faults == score.notes
