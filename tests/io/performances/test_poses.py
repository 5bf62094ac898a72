"""Poses as JSON and as NPZ: all of a performance comes back, and every fault is told where it stands."""

from __future__ import annotations

import json
import zipfile
from dataclasses import replace
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from agentface.errors import DataError
from agentface.io.performances.poses import FIELDS
from agentface.io.performances.poses_json import Lines, read_json, write_json
from agentface.io.performances.poses_npz import read_npz, write_npz
from agentface.motion.performance import Performance
from agentface.parameters import COUNT, HIGH, LOW
from tests.io.performances.conftest import some_performance

FRACTIONS = st.floats(0, 1, width=32)


@st.composite
def performances(draw):
    count = draw(st.integers(1, 4))
    times = np.cumsum(draw(st.lists(st.floats(0.001, 9), min_size=count, max_size=count)))
    rate = draw(st.none() | st.floats(0.01, 1000))
    if rate is not None and draw(st.booleans()):
        times = np.arange(count) / rate
    numbers = draw(arrays.arrays(np.float32, (count, 5), elements=FRACTIONS))
    poses = np.zeros((count, COUNT), np.float32)
    weights = np.zeros((draw(st.sampled_from([1, count])), COUNT), np.float32)
    places = draw(st.lists(st.integers(0, COUNT - 1), min_size=5, max_size=5, unique=True))
    poses[:, places] = LOW[places] + numbers * (HIGH - LOW)[places]
    weights[:, places] = draw(arrays.arrays(np.float32, (len(weights), 5), elements=FRACTIONS))
    sound = draw(st.none() | st.just(Path("a voice.wav")))
    name = draw(st.text(st.characters(exclude_categories=["Cs", "Cc"]), max_size=9))
    return Performance(times, poses.clip(LOW, HIGH), weights, rate, sound, name)


@given(performances())
def test_a_performance_comes_back_exactly(performance):
    assert read_json(write_json(performance).encode()) == performance
    assert read_npz(write_npz(performance)) == performance


def test_the_same_performance_is_the_same_bytes():
    assert write_npz(some_performance()) == write_npz(some_performance())


def test_json_is_a_line_a_frame_and_names_what_it_moves():
    lines = write_json(some_performance()).splitlines()
    document = json.loads("".join(lines))
    assert document["parameters"] == ["zygomaticus_major_l", "zygomaticus_major_r", "jaw_open", "head_yaw"]
    assert document["units"] == ["contraction", "contraction", "opening", "rad"]
    assert (document["format"], document["version"], document["rate_hz"]) == ("agentface poses", 1, 30.0)
    assert len(document["poses"]) == 3
    assert sum(line.startswith("  [") for line in lines) == 3


def test_what_may_be_left_out_is():
    small = {"format": "agentface poses", "version": 1, "rate_hz": 10, "parameters": ["jaw_open"], "poses": [[0], [1]]}
    played = read_json(json.dumps(small).encode())
    assert played.moved == ("jaw_open",)
    assert (played.duration_s, played.name, played.sound) == (0.1, "", None)


TEXT = """{
 "format": "agentface poses",
 "version": 1,
 "times_s": [0.0, 0.5],
 "weights": [
  [1, 1],
  [1, 0]
 ],
 "units": ["opening", "rad"],
 "parameters": ["jaw_open", "head_yaw"],
 "poses": [
  [0.0, 0.1],
  [0.5, 0.2]
 ]
}"""
BAD = [
    ("", 1, "valid JSON"),
    ("[1]", 1, "an object"),
    (TEXT[:-3], 14, "valid JSON"),
    (TEXT.replace("agentface poses", "poses"), 2, "format: expected 'agentface poses', got 'poses'"),
    (TEXT.replace('"version": 1', '"version": 2'), 3, "version: expected 1"),
    (TEXT.replace('"version": 1', '"version": true'), 3, "version: expected 1"),
    (TEXT.replace('"units"', '"unit"'), 9, "unit: expected no such field"),
    (TEXT.replace('"units"', '"times_s"'), 9, "times_s: expected each field once"),
    (TEXT.replace('"opening"', '"rad"'), 9, "units.0: expected opening, the unit of jaw_open, got 'rad'"),
    (TEXT.replace("jaw_open", "jaw_opn"), 10, "parameters.0: expected the name of a parameter, got 'jaw_opn'"),
    (TEXT.replace("jaw_open", "head_yaw").replace("opening", "rad"), 10, "parameters.1: expected each parameter once"),
    (TEXT.replace('["jaw_open", "head_yaw"]', "[]"), 10, "parameters: expected a list of names"),
    (TEXT.replace('["jaw_open", "head_yaw"]', "7"), 10, "parameters: expected a list of names"),
    (TEXT.replace('["opening", "rad"]', '["opening"]'), 9, "units: expected 2 units"),
    (TEXT.replace("[0.5, 0.2]", "[0.5]"), 11, "poses: expected numbers of shape (frames, 2)"),
    (TEXT.replace("[0.5, 0.2]", '[0.5, "0.2"]'), 11, "poses: expected numbers of shape (frames, 2)"),
    (TEXT.replace("[0.5, 0.2]", "[0.5, true]"), 11, "poses: expected numbers of shape (frames, 2)"),
    (TEXT.replace("[0.5, 0.2]", "[1.5, 9]"), 13, "poses.1.0: expected 0..1 for jaw_open, got 1.5"),
    (TEXT.replace("[0.5, 0.2]", "[NaN, 0]"), None, "finite numbers, got NaN"),
    (TEXT.replace("[0.5, 0.2]", "[1e999, 0]"), 13, "poses.1.0: expected 0..1 for jaw_open, got inf"),
    (TEXT.replace("[0.5, 0.2]", f"[{'9' * 400}, 0]"), 11, "poses: expected numbers"),
    (TEXT.replace("[0.5, 0.2]", f"[{'9' * 5000}, 0]"), None, "valid JSON"),
    (TEXT.replace("[0.0, 0.5]", "[0.5, 0.0]"), 4, "times_s.1: expected more than 0.5 s, got 0 s"),
    (TEXT.replace("[0.0, 0.5]", "[-1, 0.5]"), 4, "times_s.0: expected seconds in 0"),
    (TEXT.replace("[0.0, 0.5]", "[0.5]"), 4, "times_s: expected numbers of shape (2,), got those of (1,)"),
    (TEXT.replace('"times_s": [0.0, 0.5]', '"rate_hz": 0'), 4, "rate_hz: expected more than 0"),
    (TEXT.replace('"times_s": [0.0, 0.5]', '"rate_hz": 1e-9'), 4, "rate_hz: expected frames until"),
    (TEXT.replace(' "times_s": [0.0, 0.5],\n', ""), None, "times_s: expected numbers of shape (2,), got nothing"),
    (TEXT.replace("[1, 0]", "[1, 2]"), 7, "weights.1.1: expected a number in 0..1, got 2"),
    (TEXT.replace("[1, 0]", "[1]"), 5, "weights: expected numbers of shape (2,) or (2, 2)"),
    ("[" * 100_000, None, "nested too deeply"),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line", "message"), BAD)
def test_every_fault_of_json_is_told_where_it_stands(text, line, message):
    read_json(TEXT.encode())
    with pytest.raises(DataError) as caught:
        read_json(text.encode(), "a.json")
    fault = caught.value.faults[0]
    assert message in str(fault)
    assert fault.line == line


def test_lines_are_found_whatever_the_strings_hold():
    lines = Lines('{"a":\n "[{\\"\\n}",\n\n"b\\u0063": [1,\n[2],\n{"x": [3]}, "z"], "d": {}}')
    assert [lines.of(("a",)), lines.of(("bc",)), lines.of(("bc", 0)), lines.of(("bc", 1, 0)), lines.of(("bc", 3))] == [
        1, 4, 4, 5, 6,
    ]  # fmt: skip
    assert lines.of(("d",)) == 6
    assert lines.of(("nothing",)) is None
    assert lines.of(()) is None


def archive_of(**fields):
    content = BytesIO()
    with zipfile.ZipFile(content, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, field in fields.items():
            archive.writestr(f"{name}.npy", field if isinstance(field, bytes) else array_bytes(field))
    return content.getvalue()


def array_bytes(field):
    stream = BytesIO()
    np.lib.format.write_array(stream, np.asarray(field), allow_pickle=True)
    return stream.getvalue()


GIVEN = {
    "format": "agentface poses",
    "version": 1,
    "rate_hz": 10.0,
    "parameters": ["jaw_open", "head_yaw"],
    "poses": np.zeros((3, 2), np.float32),
}
LYING_TEXT = array_bytes(np.zeros(3, "U1")).replace(b"<U1", b"<U0")
LYING = array_bytes(np.zeros((3, 2), np.float32)).replace(b"(3, 2)", b"(9,99)")


def test_what_numpy_has_compressed_is_read():
    stream = BytesIO()
    np.savez_compressed(stream, **GIVEN)
    assert read_npz(stream.getvalue()) == read_npz(archive_of(**GIVEN))


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"poses": LYING}, "as the archive has"),
        ({"poses": np.array([[None, 1]])}, "numbers or texts"),
        ({"poses": b"\x93NUMPY\x01\x00"}, "an archive of NumPy arrays"),
        ({"poses": b"nothing"}, "an archive of NumPy arrays"),
        ({"poses": np.zeros((3, 2), complex)}, "poses: expected numbers"),
        ({"poses": np.array([["a", "b"]])}, "poses: expected numbers"),
        ({"poses": np.zeros((0, 2))}, "poses: expected numbers of shape (frames, 2)"),
        ({"poses": np.full((3, 2), np.nan)}, "poses.0.0: expected 0..1 for jaw_open, got nan"),
        ({"poses": np.full((3, 2), 1e99)}, "poses.0.0: expected 0..1 for jaw_open, got 1e+99"),
        ({"parameters": [b"jaw_open", b"head_yaw"]}, "parameters: expected a list of names"),
        ({"parameters": [["jaw_open", "head_yaw"]]}, "parameters: expected a list of names"),
        ({"version": [1]}, "version: expected 1"),
        ({"name": np.frombuffer(b"\xff\xff\xff\x11", "<U1")[0:1].reshape(())}, "name: expected a text"),
        ({"parameters": LYING_TEXT}, "numbers or texts"),
        ({"name": [1.0]}, "name: expected a text"),
        ({"rate_hz": "fast"}, "rate_hz: expected more than 0"),
        ({"weights": np.array(1.0)}, "weights: expected numbers"),
        (dict.fromkeys(map(str, range(len(FIELDS))), 1), "arrays of at most"),
    ],
)
def test_every_fault_of_an_archive_is_told(wrong, message):
    read_npz(archive_of(**GIVEN))
    with pytest.raises(DataError) as caught:
        read_npz(archive_of(**(GIVEN | wrong)), "a.npz")
    assert message in str(caught.value)
    assert all(fault.file == Path("a.npz") for fault in caught.value.faults)


def test_numbers_that_no_double_holds_are_a_fault_without_a_warning():
    signalling = np.zeros((3, 2), np.float32)
    signalling.view(np.uint32).flat[1] = 0x7F810001  # a NaN at whose cast processors raise a flag
    huge = np.zeros((3, 2), np.longdouble)
    huge.flat[1] = np.longdouble("1e4000")
    for numbers, got in ((signalling, "nan"), (huge, "inf")):
        with pytest.raises(DataError, match=f"got {got}"):
            read_npz(archive_of(**(GIVEN | {"poses": numbers})))


HEADS = st.tuples(st.sampled_from(sorted(GIVEN)), st.integers(0, 200), st.binary(min_size=1, max_size=6))


def try_head(name, at, put):
    content = array_bytes(GIVEN[name])
    at = min(at, len(content))
    fields = GIVEN | {name: content[:at] + put + content[at + len(put) :]}
    try:
        read_npz(archive_of(**fields))
    except DataError as error:
        faults = error.faults
    else:
        return
    assert 1 <= len(faults) <= 20


@given(HEADS)
def test_no_array_with_a_broken_head_breaks_it(head):
    try_head(*head)


@pytest.mark.soak
@settings(max_examples=50_000)
@given(HEADS)
def test_no_array_with_a_broken_head_breaks_it_for_long(head):
    try_head(*head)


@pytest.mark.parametrize("read", [read_json, read_npz])
def test_too_many_bytes_are_refused(read, monkeypatch):
    module = "poses_json" if read is read_json else "poses_npz"
    monkeypatch.setattr(f"agentface.io.performances.{module}.LARGEST_FILE", 10)
    with pytest.raises(DataError, match="at most 10 bytes"):
        read(b"x" * 11)


def test_too_many_frames_are_refused(monkeypatch):
    monkeypatch.setattr("agentface.io.performances.poses.MOST_FRAMES", 2)
    with pytest.raises(DataError, match="at most 2 frames"):
        read_npz(archive_of(**GIVEN))


def test_a_performance_that_moves_nothing_can_be_written():
    still = replace(some_performance(), poses=np.zeros((3, COUNT)), weights=np.zeros((1, COUNT)))
    assert read_json(write_json(still).encode()) == still
    assert read_npz(write_npz(still)) == still
