"""Every kind is known by its content, and what is broken, huge, empty or lies is one error with its file."""

from __future__ import annotations

import re
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from agentface.errors import DataError, OutputError
from agentface.io.performances import poses_npz, reading
from agentface.io.performances.kinds import KINDS, LARGEST_FAP, kind_of, load
from agentface.io.performances.performing import Performer
from agentface.io.performances.writing import WRITERS, action_units_of, kind_of_output, terms_of, write
from agentface.motion.performance import Performance
from tests.heads import head_model
from tests.io.performances.conftest import GOOD


def put(folder, name, data):
    path = folder / name
    path.write_bytes(data)
    return path


def test_there_is_a_good_file_of_each_kind():
    # BML makes no performance before it is spoken: tests/io/test_bml.py reads it
    assert {kind.name for kind in KINDS} - {"bml"} == GOOD.keys()


def test_content_says_the_kind_whatever_the_name_is(kind, tmp_path):
    for name in ("a", "a.txt", "a.xml", "a.fap", "a.csv", "a.json", "a.npz"):
        path = put(tmp_path, name, GOOD[kind])
        assert kind_of(path).name == kind
    found, recording = load(path)
    assert found.name == kind
    assert recording is not None


@pytest.mark.parametrize("mark", [b"\xef\xbb\xbf", b"\r\n", b"\xef\xbb\xbf\n\n"])
def test_marks_and_empty_lines_before_it_do_not_matter(kind, mark, tmp_path):
    if kind in ("poses-npz", "emotionml"):
        return
    assert kind_of(put(tmp_path, "a", mark + GOOD[kind])).name == kind
    load(put(tmp_path, "a", mark + GOOD[kind]))


@pytest.mark.parametrize("content", [b"", b"\n\n", b"hello", b"a,b,c\n1,2,3\n", b"\0" * 100, bytes(range(256))])
def test_what_is_of_no_kind_is_told_with_what_would_be(content, tmp_path):
    path = put(tmp_path, "notes", content)
    with pytest.raises(DataError) as caught:
        load(path)
    (fault,) = caught.value.faults
    assert fault.file == path
    assert all(kind.title in fault.expected for kind in KINDS)


def test_by_its_name_an_unknown_file_is_told_why_it_is_not_what_it_says(tmp_path):
    for name, message in (
        ("a.fap", "a header"),
        ("a.csv", "timestamp: expected a column of this name"),
        ("a.json", "valid JSON"),
        ("a.xml", "well-formed XML"),
        ("a.npz", "an archive of NumPy arrays"),
    ):
        with pytest.raises(DataError, match=message):
            load(put(tmp_path, name, b"x"))


def test_files_that_are_not_there_or_no_files_are_told(tmp_path):
    for path in (tmp_path / "none.fap", tmp_path):
        with pytest.raises(DataError, match="a readable file") as caught:
            load(path)
        assert caught.value.faults[0].file == path


TOKENS = [b"nan", b"-1", b"1e999", b"1e99", b"\n", b",", b"\0", b'"', b"9" * 400, b"[", b"{}", b"null"]
BROKEN = st.one_of(
    st.tuples(st.just("cut"), st.floats(0, 1)),
    st.tuples(st.just("put"), st.floats(0, 1), st.binary(max_size=20)),
    st.tuples(
        st.just("put"),
        st.floats(0, 1),
        st.sampled_from([b"nan", b"-1", b"1e999", b"1e99", b"\n", b",", b"\0", b'"', b"9" * 400]),
    ),
    st.tuples(st.just("drop"), st.floats(0, 1), st.integers(1, 60)),
    st.tuples(st.just("again"), st.floats(0, 1), st.integers(1, 200)),
)


def broken(data, deeds):
    for deed, part, *more in deeds:
        at = int(part * len(data))
        if deed == "cut":
            data = data[:at]
        elif deed == "put":
            data = data[:at] + more[0] + data[at:]
        elif deed == "drop":
            data = data[:at] + data[at + more[0] :]
        else:
            data = data[:at] + data[max(at - more[0], 0) : at] + data[at:]
    return data


def try_it(path, data):
    """Read it: either it is good, and its performance too, or there is one error that says where and what."""
    path.write_bytes(data)
    try:
        _, recording = load(path)
    except DataError as error:
        faults = error.faults
    else:
        if not hasattr(recording, "mask") and not hasattr(recording, "angles"):  # those need a solver
            assert isinstance(Performer(head_model()).performance(recording, path), Performance)
        return
    assert faults
    assert all(fault.file == path and fault.expected and str(fault).startswith(str(path)) for fault in faults)
    if not path.name.startswith("emotionml"):
        assert len(faults) <= 20


def test_numbers_that_no_float32_holds_are_told_or_limited(kind, tmp_path):
    if kind == "poses-npz":
        return  # tests/io/performances/test_poses.py
    good = GOOD[kind]
    for number in re.finditer(rb"-?[0-9]+(\.[0-9]+)?", good):
        try_it(tmp_path / kind, good[: number.start()] + b"-1e99"[number.start() % 2 :] + good[number.end() :])


FUZZ = settings(suppress_health_check=[HealthCheck.function_scoped_fixture])


@FUZZ
@given(deeds=st.lists(BROKEN, min_size=1, max_size=4))
def test_no_broken_file_breaks_a_reader(kind, deeds, tmp_path):
    try_it(tmp_path / kind, broken(GOOD[kind], deeds))


@FUZZ
@given(data=st.binary(max_size=300))
def test_no_bytes_break_a_reader(kind, data, tmp_path):
    suffix = next(each.suffix for each in KINDS if each.name == kind)
    try_it(tmp_path / f"{kind}{suffix}", data)


@pytest.mark.soak
@settings(max_examples=20_000, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(deeds=st.lists(BROKEN, min_size=1, max_size=8))
def test_no_broken_file_breaks_a_reader_for_long(kind, deeds, tmp_path):
    try_it(tmp_path / kind, broken(GOOD[kind], deeds))


def huge(path, begin, size):
    """A file of ``size`` bytes that takes no place on the disk."""
    with path.open("wb") as file:
        file.write(begin)
        file.truncate(size)
    return path


def test_a_gigabyte_is_refused_and_never_in_memory(kind, tmp_path):
    path = huge(tmp_path / f"huge{next(each.suffix for each in KINDS if each.name == kind)}", GOOD[kind], 1 << 30)
    tracemalloc.start()
    with pytest.raises(DataError) as caught:
        load(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert caught.value.faults[0].file == path
    assert peak < 1.5 * max(LARGEST_FAP, poses_npz.LARGEST_FILE)


def test_tables_are_read_line_by_line(tmp_path):
    """Wide rows of which few columns are used: memory goes with what is used."""
    rows = 4000
    head = "frame, timestamp, AU12_r" + "".join(f", x_{place}" for place in range(700))
    path = tmp_path / "wide.csv"
    with path.open("w") as file:
        file.write(head + "\n")
        for row in range(rows):
            file.write(f"{row},{row / 30:.6f},1.5" + ",300.125" * 700 + "\n")
    tracemalloc.start()
    _, stream = load(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(stream) == rows
    assert peak < path.stat().st_size / 10


def test_a_table_of_too_many_rows_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr("agentface.io.performances.table.MOST_FRAMES", 10)
    rows = "".join(f"{row / 30:.6f},1\n" for row in range(11))
    with pytest.raises(DataError, match="at most 10 rows"):
        load(put(tmp_path, "a.csv", b"timestamp,AU12_r\n" + rows.encode()))


def test_a_line_without_end_is_refused(tmp_path):
    data = b"timestamp,AU12_r\n" + b"1" * (reading.LONGEST_LINE + 10)
    with pytest.raises(DataError, match=":2: expected a line of at most"):
        load(put(tmp_path, "a.csv", data))


def test_a_small_archive_with_much_in_it_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr(poses_npz, "LARGEST_CONTENT", 1000)
    with pytest.raises(DataError, match="at most 1,000 bytes"):
        load(put(tmp_path, "a.npz", GOOD["poses-npz"]))


def test_what_is_written_is_read_again_as_the_same_kind(tmp_path):
    for name in WRITERS:
        _, recording = load(put(tmp_path, "in", GOOD[name]))
        kind = kind_of_output(tmp_path / "out", name)
        assert isinstance(recording, terms_of(kind))
        write(tmp_path / "out", kind, recording)
        if name == "emotionml":
            assert load(tmp_path / "out")[1].cues == recording.cues
        else:
            assert (tmp_path / "out").read_bytes() == GOOD[name], name


def test_the_name_of_an_output_says_its_kind(tmp_path):
    for suffix, name in ((".fap", "fap"), (".CSV", "openface"), (".json", "poses-json"), (".npz", "poses-npz")):
        assert kind_of_output(Path(f"a{suffix}")).name == name
    with pytest.raises(OutputError, match=r"ends in one of \.fap"):
        kind_of_output(Path("a.mp4"))


def test_a_score_becomes_what_the_rules_make_of_it(tmp_path):
    _, score = load(put(tmp_path, "a.xml", GOOD["emotionml"]))
    played = Performer(head_model()).performance(score, tmp_path / "a.xml")
    assert played.rate_hz == 60.0
    assert played.duration_s >= score.length_s
    from agentface.emotion.inference import default_inference

    wanted = default_inference().pose({"surprise": 0.5}).array
    values, _ = played.sample(0.4)
    np.testing.assert_allclose(values, wanted, atol=1e-5)
    assert not played.poses[-1].any()
    assert action_units_of(played).intensities.max() > 0.2


def test_arkits_weights_are_played(tmp_path):
    path = put(tmp_path, "take.csv", GOOD["live-link"])
    _, stream = load(path)
    performance = Performer(head_model()).performance(stream, path)
    np.testing.assert_array_equal(performance.times_s, stream.times_s)
    assert {"jaw_open", "gaze_yaw", "tongue_out", "head_yaw"} <= set(performance.moved)
