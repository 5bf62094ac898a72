from __future__ import annotations

from pathlib import Path
from xml.sax.saxutils import quoteattr

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.bml.block import Aim, Block, Nod, Precedence, Show, SyncPoint, SyncTime, Text
from agentface.errors import DataError
from agentface.io.bml.reader import LARGEST_FILE, MOST_BEHAVIORS, is_bml, load_bml, read_bml
from agentface.io.performances.kinds import kind_of

EXAMPLES = Path(__file__).parents[2] / "examples"
HEAD = '<bml xmlns="http://www.bml-initiative.org/bml/bml-1.0" id="block"'


def read(inside, **attributes):
    extra = "".join(f" {key}={quoteattr(value)}" for key, value in attributes.items())
    return read_bml(f"{HEAD}{extra}>\n{inside}\n</bml>")


def only(inside):
    block = read(inside)
    assert not block.notes
    (behavior,) = block.behaviors
    return behavior


def faults(inside, **attributes):
    with pytest.raises(DataError) as caught:
        read(inside, **attributes)
    return [str(fault) for fault in caught.value.faults]


def notes(inside):
    return [str(note) for note in read(inside).notes]


def test_a_face_shows_lexemes_and_action_units():
    assert only('<faceLexeme id="a" lexeme="SMILE"/>').does == (Show("happiness", 0.5),)
    assert only('<faceLexeme id="a" lexeme="joy" amount="0.8"/>').does == (Show("happiness", 0.8),)
    assert only('<faceFacs id="a" au="1" side="LEFT" amount="1"/>').does == (Show(1, 1.0, "l"),)
    assert only('<faceFacs id="a" au="12"/>').does == (Show(12, 0.5, "l"), Show(12, 0.5, "r"))
    assert only('<faceLexeme id="a" lexeme="raise-left brow" amount="1"/>').does == (
        Show(1, 1.0, "l"),
        Show(2, 1.0, "l"),
    )
    both = '<face id="a" amount="0.5"><lexeme lexeme="SMILE" amount="1"/><facs au="30" amount="0.4"/></face>'
    assert only(both).does == (Show("happiness", 0.5), Show(30, 0.2, None))
    shift = only('<faceShift id="a" lexeme="SMILE"/>')
    assert (shift.kind, shift.points) == ("face_shift", ("start", "end"))


def test_a_gaze_looks_beside_a_target():
    user = only('<gaze id="a" target="user"/>').does
    assert isinstance(user, Aim)
    assert (user.yaw_deg, user.pitch_deg, user.head_share) == (0.0, 0.0, 0.0)
    aside = only('<gazeShift id="a" target="USER" offsetAngle="20" offsetDirection="UPLEFT" influence="HEAD"/>').does
    assert (aside.yaw_deg, aside.pitch_deg) == pytest.approx((14.142, 14.142), abs=1e-3)
    assert aside.head_share > 0.0
    right = only('<gaze id="a" target="USER" offsetAngle="20"/>').does
    assert right.yaw_deg == -20.0, "the standard's usual direction is the person's right"
    behind = only('<gaze id="a" target="USER" offsetAngle="180" offsetDirection="LEFT"/>').does
    assert behind.yaw_deg == 80.0, "what is not in front of the eyes is looked for as far as they go"
    assert only('<headDirectionShift id="a" target="LEFT"/>').does.yaw_deg > 0.0


def test_a_head_nods_as_often_as_it_says():
    once, thrice = only('<head id="a" lexeme="NOD"/>'), only('<head id="a" lexeme="NOD" repetition="3" amount="1"/>')
    assert once.does == Nod("nod", 0.5, 1)
    assert thrice.does == Nod("nod", 1.0, 3)
    assert sum(thrice.usual_s) == pytest.approx(3 * sum(once.usual_s))


def test_a_speech_keeps_its_text_and_syncs_in_order():
    said = only(
        '<speech id="s"><text>Hello <sync id="one"/>big <!-- - -->&amp; <sync id="two"/>bad world</text></speech>'
    )
    assert said.does == Text(("Hello ", "big & ", "bad world"), ("one", "two"))
    assert said.points == ("start", "one", "two", "end")


def test_times_are_seconds_or_sync_points():
    block = read(
        '<wait id="a-1" start="1.5" duration="2"/>'
        '<wait id="b" start="a-1:end"/><wait id="c" start=" a-1:end + 0.5 "/><wait id="d" end="block:c:start-1"/>'
        '<wait id="e" start="bml:start+1"/><wait id="f" start="other:x:stroke"/><wait id="g" start="o:bml:end"/>'
    )
    found = [behavior.anchors[0][1] for behavior in block.behaviors]
    assert found == [
        SyncTime(SyncPoint(), 1.5),
        SyncTime(SyncPoint("a-1", "end")),
        SyncTime(SyncPoint("a-1", "end"), 0.5),
        SyncTime(SyncPoint("c", "start"), -1.0),
        SyncTime(SyncPoint(), 1.0),
        SyncTime(SyncPoint("x", "stroke", "other")),
        SyncTime(SyncPoint("", "end", "o")),
    ]


def test_constraints_say_what_meets_and_what_comes_first():
    block = read(
        '<wait id="a"/><wait id="b"/><constraint id="c">'
        '<synchronize><sync ref="a:end"/><sync ref="b:start+1"/></synchronize>'
        '<before ref="b:end"><sync ref="a:start"/></before><after ref="a:start"><sync ref="b:end"/></after>'
        "</constraint>"
    )
    assert block.meetings[0].points == (SyncTime(SyncPoint("a", "end")), SyncTime(SyncPoint("b", "start"), 1.0))
    first = SyncTime(SyncPoint("a", "start")), SyncTime(SyncPoint("b", "end"))
    assert block.orders == (Precedence(*first, 2, before=True), Precedence(*first, 2))


def test_the_block_says_how_it_comes_and_for_whom():
    block = read('<required><wait id="a"/></required>', composition="append", characterId="Ann")
    assert (block.id, block.composition, block.character) == ("block", "APPEND", "Ann")
    assert [behavior.id for behavior in block.behaviors] == ["a"]


@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        ('<gesture id="g" lexeme="BEAT"/>', "g: expected what a face does, got <gesture>"),
        ('<faceLexeme id="f" lexeme="SMIRKING"/>', "f.lexeme: expected a lexeme of bml.yaml, or an emotion"),
        ('<walk xmlns="urn:other" id="w"/>', "w: expected a behavior of BML 1.0, got <walk>"),
    ],
)
def test_a_block_that_requires_what_is_not_shown_is_refused(inside, expected):
    with pytest.raises(DataError, match=expected):
        read(f'<wait id="a"/><required><wait id="b"/>{inside}</required>')
    block = read(f'<required><wait id="a"/></required>{inside}')
    assert len(block.notes) == 1


def test_what_is_not_a_face_s_is_left_out_and_others_may_wait_for_it():
    inside = (
        '<gesture id="g" lexeme="BEAT"/>\n<pointing id="p" target="x"/>\n<posture id="q"/>\n<postureShift id="r"/>\n'
        '<locomotion id="l" target="x"/>\n<walk xmlns="urn:other" id="w"/>\n'
        '<faceLexeme id="f" lexeme="SMILE" start="g:stroke"/>\n<gaze id="z" target="moon"/>\n'
        '<faceFacs id="u" au="99"/>\n<faceLexeme id="v" lexeme="SMILEY"/>\n<head id="h" lexeme="TOSS"/>\n'
        '<wait id="t" colour="red"/>'
    )
    told = notes(inside)
    lines = [int(note.split(":")[1]) for note in told]
    assert lines == list(range(2, 8)) + list(range(9, 14))
    assert "did you mean SMILE" in told[8]
    assert read(inside).behaviors[6].anchors[0][1].point == SyncPoint("g", "stroke")


@pytest.mark.parametrize(
    ("inside", "expected"),
    [
        ('<wait id="a"/>\n<wait id="a"/>', "block.bml:3: a: expected each id once"),
        ("<wait/>", "wait.id: expected an id, got none"),
        ('<wait id="1a"/>', "1a.id: expected a letter"),
        ('<faceLexme id="a"/>', "expected a behavior of BML 1.0, got <faceLexme> (did you mean faceLexeme"),
        ('<faceLexeme id="a"/>', "a.lexeme: expected this attribute"),
        ('<faceFacs id="a" au="one"/>', "a.au: expected the number of an action unit"),
        ('<faceFacs id="a" au="1" side="up"/>', "a.side: expected one of LEFT, RIGHT, BOTH"),
        ('<faceLexeme id="a" lexeme="SMILE" amount="2"/>', "a.amount: expected a number in 0..1, got '2'"),
        ('<faceLexeme id="a" lexeme="SMILE" amount="nan"/>', "a.amount: expected a number in 0..1"),
        ('<gaze id="a"/>', "a.target: expected this attribute"),
        ('<gaze id="a" target="USER" influence="FEET"/>', "a.influence: expected one of EYES"),
        ('<head id="a" lexeme="NOD" repetition="1.5"/>', "a.repetition: expected a whole number"),
        ('<speech id="a"/>', "a: expected one <text>, got none"),
        ('<speech id="a"><text> ... </text></speech>', "a: expected something that can be spoken"),
        ('<speech id="a"><text>b<sync/>c</text></speech>', "a.sync.id: expected an id"),
        ('<speech id="a"><text>b<sync id="end"/>c</text></speech>', "a: expected each sync point once, got 'end'"),
        ('<wait id="a" start="soon"/>', "a.start: expected seconds, or a sync point such as"),
        ('<wait id="a" start="-1"/>', "a.start: expected 0..3600 s"),
        ('<wait id="a" start="b:end"/>', "a.start: expected the id of a behavior, got 'b'"),
        ('<head id="n" lexeme="NOD"/><wait id="a" start="n:strok"/>', "a sync point of n, got 'strok' (did you mean"),
        ('<wait id="a" start="a:end+1"/>', "sync points that can be in their order, got a circle: a:"),
        ('<constraint id="c"><synchronize><sync ref="b:end"/></synchronize></constraint>', "two sync points or more"),
        ('<constraint id="c"><after><sync ref="bml:start"/></after></constraint>', "constraint.ref: expected this"),
        ('<constraint id="c"><during/></constraint>', "expected synchronize, before or after, got <during>"),
        ('<required><required><wait id="a"/></required></required>', "expected a behavior of BML 1.0, got <required>"),
    ],
)
def test_what_the_standard_forbids_is_told_with_its_line(inside, expected):
    told = faults(inside)
    assert any(expected in fault for fault in told), told
    assert all(fault.startswith("block.bml:") for fault in told)


def test_all_faults_come_at_once():
    told = faults('<wait/>\n<gaze id="g"/>\n<head id="h"/>', composition="BLEND")
    assert [int(fault.split(":")[1]) for fault in told] == [1, 2, 3, 4]


def test_too_much_is_refused():
    with pytest.raises(DataError, match=f"at most {LARGEST_FILE} bytes"):
        read_bml(b" " * (LARGEST_FILE + 1))
    waits = "".join(f'<wait id="w{number}"/>' for number in range(MOST_BEHAVIORS + 1))
    assert "at most 100 behaviors" in faults(waits)[0]
    with pytest.raises(DataError, match="at most 100000 characters"):
        read(f'<speech id="s"><text>{"a " * 60_000}</text></speech>')
    with pytest.raises(DataError, match="no document type"):
        read_bml(f"<!DOCTYPE bml [<!ENTITY a 'b'>]>{HEAD}/>")


def test_the_example_is_known_by_its_content_and_plays(tmp_path):
    path = EXAMPLES / "greeting.bml"
    assert kind_of(path).name == "bml"
    renamed = tmp_path / "greeting.xml"
    renamed.write_bytes(path.read_bytes())
    assert kind_of(renamed).name == "bml"
    block = load_bml(renamed)
    assert [note.line for note in block.notes] == [12]
    assert not is_bml((EXAMPLES / "moods.xml").read_bytes())
    assert is_bml(b"<bml id='x'/>")
    assert is_bml(b"\xef\xbb\xbf<?xml version='1.0'?>\n<!-- <emotionml> -->\n<b:bml xmlns:b='x' id='x'/>")


def test_a_beginning_of_many_comments_is_known_soon():
    assert not is_bml(b"<!-- --><?x ?> " * 4000)
    assert is_bml(b"<!-- --><?x ?> " * 4000 + b"<bml>")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-16-le", "utf-16-be"])
def test_it_may_be_written_in_utf_16(tmp_path, encoding):
    mark = "" if encoding == "utf-16" else "\ufeff"
    for text, known in (('<bml id="x"><wait id="ä"/></bml>', "bml"), ("<emotionml/>", "emotionml")):
        path = tmp_path / f"{known}.txt"
        path.write_bytes(f'{mark}<?xml version="1.0" encoding="UTF-16"?>\n{text}'.encode(encoding))
        assert is_bml(path.read_bytes()) == (known == "bml")
        assert kind_of(path).name == known
    assert load_bml(tmp_path / "bml.txt").behaviors[0].id == "ä"


def block_or_faults(data):
    try:
        block = read_bml(data, "x.bml")
    except DataError as error:
        told = error.faults
    else:
        assert isinstance(block, Block)
        return block
    assert len(told) in range(1, 1001)
    assert all(str(fault).startswith("x.bml") and len(str(fault)) < 6000 for fault in told)
    return None


@given(st.binary(max_size=300))
def test_any_bytes_are_faults(data):
    assert block_or_faults(data) is None


@given(st.integers(0, 2000), st.integers(0, 30), st.binary(max_size=10))
def test_a_damaged_document_is_a_block_or_faults(at, length, instead):
    data = (EXAMPLES / "greeting.bml").read_bytes()
    block_or_faults(data[:at] + instead + data[at + length :])


TAGS = (
    "bml face faceLexeme faceFacs faceShift gaze gazeShift head headDirectionShift speech text sync wait constraint"
    " synchronize before after required gesture lexeme facs x"
)
KEYS = "id start end stroke relax ready lexeme au amount side target ref repetition influence"
VALUES = "a b c NOD SMILE USER 0.5 1 a:end b:start+1 c:stroke-0.5 LEFT"
NAMES = st.sampled_from(TAGS.split())
ATTRIBUTES = st.dictionaries(
    st.sampled_from(KEYS.split()),
    st.one_of(st.sampled_from(VALUES.split()), st.text("ab:+-1", max_size=8)),
    max_size=5,
)
ELEMENTS = st.recursive(
    st.tuples(NAMES, ATTRIBUTES, st.just([])),
    lambda inner: st.tuples(NAMES, ATTRIBUTES, st.lists(inner | st.text("ab ", max_size=5), max_size=5)),
    max_leaves=12,
)


def written(element):
    if isinstance(element, str):
        return element
    name, attributes, children = element
    told = "".join(f" {key}={quoteattr(value)}" for key, value in attributes.items())
    return f"<{name}{told}>{''.join(map(written, children))}</{name}>"


@pytest.mark.untraced
@given(st.lists(ELEMENTS, max_size=6))
def test_any_elements_are_a_block_or_faults(elements):
    block_or_faults(f'<bml id="z">{"".join(map(written, elements))}</bml>')


def test_a_circle_of_a_hundred_is_found_soon():
    ring = "".join(f'<head id="h{n}" lexeme="NOD" start="h{(n + 1) % 100}:end"/>' for n in range(100))
    assert "circle" in faults(ring)[0]
