from __future__ import annotations

import time
import tracemalloc

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from agentface.errors import DataError, InvalidValueError
from agentface.mpeg4.fap_file import LONGEST_LINE, read_fap, write_fap
from agentface.mpeg4.fap_stream import EXPRESSION_FIELDS, LARGEST, VISEME_FIELDS, FapStream
from agentface.mpeg4.fap_table import FAP_COUNT

NAMES = st.text(st.characters(exclude_categories=["Cc", "Cs", "Z"]), min_size=1, max_size=12)
PATHS = st.lists(NAMES, min_size=1, max_size=3).map(" ".join).map(lambda name: f"C:\\faps\\{name}")


def fields(draw, count, largest):
    columns = [draw(arrays.arrays(np.int32, count, elements=st.integers(0, most))) for most in largest.values()]
    return np.stack(columns, axis=1)


@st.composite
def streams(draw):
    count = draw(st.integers(1, 4))
    return FapStream(
        draw(st.sampled_from(["2.0", "2.1"])),
        draw(NAMES | PATHS),
        draw(st.sampled_from([25.0, 30.0, 29.97, 30000 / 1001, 0.001]) | st.floats(0.001, 1000)),
        draw(arrays.arrays(np.int32, (count, FAP_COUNT), elements=st.integers(-LARGEST, LARGEST))),
        draw(arrays.arrays(np.bool_, (count, FAP_COUNT))),
        fields(draw, count, VISEME_FIELDS),
        fields(draw, count, EXPRESSION_FIELDS),
    )


@given(streams())
def test_a_stream_comes_back_exactly(stream):
    text = write_fap(stream)
    assert read_fap(text) == stream
    assert write_fap(read_fap(text)) == text


def masks(*on):
    return " ".join("1" if fap in on else "0" for fap in range(1, FAP_COUNT + 1))


PLAIN = f"2.1 jaw.fap 25 2\n{masks(3, 48)}\n0 100 -5\n{masks(3, 48)}\n1 200 5\n"


def wild(text):
    """What is found in files of others, each with the same two frames of FAPs 3 and 48."""
    extra = text.replace("\n0 100", " 0\n0 100").replace("\n1 200", " 0\n1 200")
    from_one = text.replace("\n1 200", "\n2 200").replace("\n0 100", "\n1 100")
    yield "69 masks", extra
    yield "frames from 1", from_one
    yield "tabs", text.replace(" ", "\t")
    yield "CR LF", text.replace("\n", "\r\n")
    yield "CR", text.replace("\n", "\r")
    yield "no last end of line", text.rstrip("\n")
    yield "blanks at the ends", text.replace("\n", "  \n").replace("\n", "\n ")
    yield "comments", "# made by hand\n#\n" + text.replace("\n0 100", "\n# frame 0\n0 100") + "# the end"
    yield "empty lines", "\n\n" + text.replace("\n", "\n\n")
    yield "a byte order mark", "\ufeff" + text
    yield "all of it", ("\ufeff# x\r\n" + extra.replace(" ", "\t").replace("\n", "\r\n")).rstrip()


@pytest.mark.parametrize("text", [pytest.param(text, id=name) for name, text in wild(PLAIN)])
def test_what_is_found_in_the_wild_is_read(text):
    assert read_fap(text) == read_fap(PLAIN)


def test_names_with_backslashes_and_spaces_and_old_versions_are_read():
    stream = read_fap(PLAIN.replace("2.1 jaw.fap 25", "2.0   C:\\my  faps\\jaw 1.fap \t 29.97"))
    assert (stream.version, stream.name, stream.rate, len(stream)) == ("2.0", "C:\\my  faps\\jaw 1.fap", 29.97, 2)
    assert stream.values[:, 2].tolist() == [100, 200]
    assert stream.values[:, 47].tolist() == [-5, 5]
    assert stream.mask.sum() == 4
    assert not stream.visemes.any()


def test_fap_1_has_four_fields_and_fap_2_six():
    text = f"2.1 both 25 2\n{masks(1, 2, 3)}\n0 4 5 63 0 1 60 3 10 1 0 700\n{masks(2, 68)}\n1 6 63 0 0 0 1 -9\n"
    stream = read_fap(text)
    assert stream.visemes.tolist() == [[4, 5, 63, 0], [0, 0, 0, 0]]
    assert stream.expressions.tolist() == [[1, 60, 3, 10, 1, 0], [6, 63, 0, 0, 0, 1]]
    assert stream.values[:, [0, 1, 2, 67]].tolist() == [[0, 0, 700, 0], [0, 0, 0, -9]]
    assert write_fap(stream) == text


BAD = [
    ("", None, "header: expected a header"),
    ("# only this\n", None, "header: expected a header"),
    ("2.1 25 2", 1, "header: expected a header"),
    (PLAIN.replace("2.1", "3.0"), 1, "version: expected 2.0 or 2.1, got '3.0'"),
    (PLAIN.replace(" 25 ", " 0 "), 1, "rate: expected frames a second"),
    (PLAIN.replace(" 25 ", " -25 "), 1, "rate: expected frames a second"),
    (PLAIN.replace(" 25 ", " nan "), 1, "rate: expected frames a second"),
    (PLAIN.replace(" 25 ", " 1e400 "), 1, "rate: expected frames a second"),
    (PLAIN.replace(" 25 2", " 25 0"), 1, "frames: expected their number"),
    (PLAIN.replace(" 25 2", " 25 2.0"), 1, "frames: expected their number"),
    (PLAIN.replace(" 25 2", " 25 3"), 5, "expected 3 frames, as the header says, got 2"),
    (PLAIN.replace(" 25 2", " 25 1"), 5, "expected 1 frames, as the header says, got 2"),
    (PLAIN.replace(" 25 2", " 25 999999999"), 5, "expected 999999999 frames"),
    (PLAIN.replace("\n0 100", " 0 0\n0 100"), 2, "frame 0: expected a mask of 68 numbers, got 70 numbers"),
    (PLAIN.replace("0 0\n1 200", "0\n1 200"), 4, "frame 1: expected a mask of 68 numbers, got 67 numbers"),
    (PLAIN.replace("25 2\n0 0", "25 2\n0 2"), 2, "frame 0: expected masks of 0 or 1, got 2"),
    (PLAIN.replace("0 100 -5", "0 100"), 3, "frame 0: expected 2 values, as the mask says, got 1"),
    (PLAIN.replace("0 100 -5", "0 100 -5 3"), 3, "frame 0: expected 2 values, as the mask says, got 3"),
    (PLAIN.replace("100", "100.5"), 3, "frame 0: expected whole numbers of at most nine digits, got '100.5'"),
    (PLAIN.replace("100", "nan"), 3, "frame 0: expected whole numbers"),
    (PLAIN.replace("100", "1234567890"), 3, "frame 0: expected whole numbers"),
    (PLAIN.replace("100", "1_0"), 3, "frame 0: expected whole numbers"),
    (PLAIN.replace("100", "٣"), 3, "frame 0: expected whole numbers"),
    (PLAIN.replace("\n1 200", "\n7 200"), 5, "frame 1: expected the frame's number, 1, got 7"),
    (PLAIN.replace("\n0 100", "\n2 100"), 3, "frame 0: expected the frame's number, 0, got 2"),
    (PLAIN[: PLAIN.index("1 200")], 4, "frame 1: expected a line of values after the mask, got the end"),
    (f"2.1 v 25 1\n{masks(1)}\n0 15 0 0 0", 3, "frame 0.FAP 1 select1: expected a number in 0..14, got 15"),
    (f"2.1 v 25 1\n{masks(1)}\n0 1 0 64 0", 3, "frame 0.FAP 1 blend: expected a number in 0..63, got 64"),
    (f"2.1 v 25 1\n{masks(2)}\n0 1 0 0 0 2 0", 3, "frame 0.FAP 2 init_face: expected a number in 0..1, got 2"),
    (f"2.1 v 25 1\n{'0 ' * LONGEST_LINE}", 2, f"expected a line of at most {LONGEST_LINE} characters"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line", "message"), BAD)
def test_what_is_wrong_is_told_with_its_line(text, line, message):
    with pytest.raises(DataError) as caught:
        read_fap(text, "a/jaw.fap")
    fault = caught.value.faults[0]
    assert message in str(fault)
    assert str(fault).startswith("a/jaw.fap")
    assert fault.line == line


def test_all_faults_are_told_but_not_without_end():
    with pytest.raises(DataError) as caught:
        read_fap(PLAIN.replace("100", "x").replace("200 5", "200"))
    assert [fault.line for fault in caught.value.faults] == [3, 5]
    many = "2.1 many 25 1000\n" + "".join(f"{masks(3)}\n{frame} x\n" for frame in range(1000))
    with pytest.raises(DataError) as caught:
        read_fap(many)
    assert len(caught.value.faults) == 20


ANYTHING = st.text(max_size=200) | st.binary(max_size=200).map(lambda data: data.decode("latin-1"))


@given(ANYTHING)
@example("2.1 x 25 1\n" + "1 " * 68 + "\n")
def test_no_text_breaks_it(text):
    refused_or_good(text)


@given(streams().map(write_fap), st.data())
def test_no_broken_stream_breaks_it(text, data):
    for _ in range(data.draw(st.integers(1, 4))):
        start, end = sorted(data.draw(st.tuples(st.integers(0, len(text)), st.integers(0, len(text)))))
        put = data.draw(st.sampled_from(["", "\n", " 1", "nan", "-", "\0", text[start:end]]))
        text = text[:start] + put + text[end:]
    refused_or_good(text)


def refused_or_good(text):
    try:
        stream = read_fap(text)
    except DataError as error:
        faults = error.faults
    else:
        assert read_fap(write_fap(stream)) == stream
        return
    assert 1 <= len(faults) <= 20
    assert all(fault.expected for fault in faults)


def test_memory_stays_near_the_size_of_the_text():
    text = "2.1 long 25 3000\n" + "".join(f"{masks()}\n{frame}\n" for frame in range(3000))
    read_fap(PLAIN)  # what is imported for it counts as well
    tracemalloc.start()
    read_fap(text)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 10 * len(text), peak / len(text)


def test_what_is_no_stream_is_refused():
    good = read_fap(PLAIN)
    given = {name: getattr(good, name) for name in FapStream.__dataclass_fields__}
    for wrong, message in (
        ({"version": "1.0"}, "version"),
        ({"name": ""}, "one line"),
        ({"name": "a\nb"}, "one line"),
        ({"name": " a"}, "without blanks"),
        ({"rate": 0}, "rate"),
        ({"mask": good.mask[:, :-1]}, "mask"),
        ({"mask": good.mask[:0]}, "one frame or more"),
        ({"values": good.values.astype(np.float32)}, "whole numbers"),
        ({"values": good.values[:1]}, "values"),
        ({"values": good.values.astype(np.int64) * 10**9}, "numbers in"),
        ({"mask": np.ones_like(good.mask), "visemes": good.visemes + 99}, "visemes select1"),
    ):
        with pytest.raises(InvalidValueError, match=message):
            FapStream(**(given | wrong))


def test_what_is_measured_becomes_whole_numbers_of_all_low_level_faps():
    stream = FapStream.measured(np.full((3, FAP_COUNT), 1.6), 30)
    assert stream.values[:, 2:].tolist() == [[2] * 66] * 3
    assert not stream.mask[:, :2].any()
    assert stream.mask[:, 2:].all()
    assert read_fap(write_fap(stream)) == stream


@pytest.mark.soak
def test_an_hour_of_faps_is_read_in_seconds():
    faps = np.random.default_rng(0).integers(-1000, 1000, (90_000, FAP_COUNT))
    text = write_fap(FapStream.measured(faps, 25))
    start = time.perf_counter()
    assert len(read_fap(text)) == 90_000
    print(f"{len(text) / 1e6:.0f} MB in {time.perf_counter() - start:.1f} s")  # noqa: T201 - a figure for who runs it
