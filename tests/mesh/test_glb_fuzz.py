"""Files that are no GLB, or a broken one, are one fault each: no other error, and no memory beyond the file's."""

from __future__ import annotations

import copy
import json
import struct
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from agentface.errors import DataError
from agentface.mesh import glb
from agentface.mesh.glb import MeshArrays, Shape, encode_glb, read_glb

MESH = MeshArrays(
    np.array([[0, 1, 2]], np.int32),
    {"POSITION": np.eye(3, dtype=np.float32), "_BYTES": np.ones((3, 3), np.uint8)},
    {"moved": Shape(np.array([1], np.int32), np.ones((1, 3), np.float32))},
    {"of": "a triangle"},
)
GOOD = encode_glb({"mesh": MESH}, "nobody")
TEXT = json.loads(GOOD[20 : 20 + struct.unpack_from("<I", GOOD, 12)[0]])
BINARY = GOOD[20 + struct.unpack_from("<I", GOOD, 12)[0] :]
ANY = st.recursive(
    st.none() | st.booleans() | st.integers(-(10**30), 10**30) | st.floats() | st.text(max_size=4),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=4,
)


def file_of(text: object, binary: bytes = BINARY) -> bytes:
    raw = json.dumps(text).encode()
    raw += b" " * (-len(raw) % 4)
    return struct.pack("<4sIII4s", b"glTF", 2, 20 + len(raw) + len(binary), len(raw), b"JSON") + raw + binary


def read(folder: Path, content: bytes) -> dict[str, MeshArrays] | None:
    """What is read, or None for one fault that names the file."""
    path = folder / "any.glb"
    path.write_bytes(content)
    try:
        return read_glb(path)
    except DataError as error:
        faulty = {fault.file for fault in error.faults}
    assert faulty == {path}
    return None


def places(text: object, here: tuple = ()) -> list[tuple]:
    """The paths to everything in a JSON text."""
    found = [here]
    pairs = text.items() if isinstance(text, dict) else enumerate(text) if isinstance(text, list) else ()
    for key, value in pairs:
        found += places(value, (*here, key))
    return found


def replaced(text: dict, path: tuple, value: object) -> object:
    if not path:
        return value
    changed = copy.deepcopy(text)
    at = changed
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    return changed


def test_the_good_one_is_read(tmp_path):
    (found,) = read(tmp_path, file_of(TEXT)).values()
    np.testing.assert_array_equal(found.attributes["POSITION"], np.eye(3))


@settings(max_examples=300, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.sampled_from(places(TEXT)), ANY)
def test_anything_in_place_of_anything(tmp_path, path, value):
    read(tmp_path, file_of(replaced(TEXT, path, value)))


@settings(max_examples=200, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_bytes_changed_and_cut(tmp_path, data):
    content = bytearray(GOOD)
    for _ in range(data.draw(st.integers(0, 8))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    read(tmp_path, bytes(content[: data.draw(st.integers(0, len(content)))]))


@pytest.mark.parametrize(
    ("path", "value", "said"),
    [
        (("accessors", 0, "count"), 10**400, "Error"),
        (("accessors", 0, "count"), 10**9, "accessors of more than"),
        (("accessors", 0, "count"), -1, "-3 components"),
        (("accessors", 0, "bufferView"), 99, "number 99 of"),
        (("accessors", 0, "bufferView"), -1, "number -1 of"),
        (("accessors", 0, "byteOffset"), -4, "-4"),
        (("accessors", 0, "componentType"), 5130, "5130"),
        (("bufferViews", 0, "byteStride"), 10**6, "rows of 1000000 bytes"),
        (("bufferViews", 0, "byteStride"), 1, "rows of 1 bytes"),
        (("meshes", 0, "primitives"), [], "IndexError"),
        (("meshes", 0, "name"), ["a"], "TypeError"),
        (("meshes", 0, "extras", "targetNames"), ["a", "b"], "ValueError"),
        (("meshes",), 7, "TypeError"),
        ((), [1, 2], "TypeError"),
    ],
)
def test_known_ways_to_be_malformed(tmp_path, path, value, said):
    (tmp_path / "any.glb").write_bytes(file_of(replaced(TEXT, path, value)))
    with pytest.raises(DataError, match=f"any.glb.*{said}"):
        read_glb(tmp_path / "any.glb")


@pytest.mark.parametrize("content", [b"", b"glTF", b"{}", GOOD[:20], b"glTF" + bytes(30)])
def test_no_glb_at_all(tmp_path, content):
    assert read(tmp_path, content) is None


def test_nested_without_end(tmp_path):
    raw = b"[" * 1_000_000
    content = struct.pack("<4sIII4s", b"glTF", 2, 20 + len(raw), len(raw), b"JSON") + raw
    assert read(tmp_path, content) is None


def test_one_accessor_read_ever_again_takes_no_more_memory_than_the_bound(tmp_path, monkeypatch):
    monkeypatch.setattr(glb, "_MOST_READ", 1 << 20)
    count = 10_000
    mesh = MeshArrays(np.zeros((1, 3), np.int32), {"POSITION": np.zeros((count, 3), np.float32)})
    content = encode_glb({"mesh": mesh}, "")
    text = json.loads(content[20 : 20 + struct.unpack_from("<I", content, 12)[0]])
    text["bufferViews"][0]["byteStride"] = 16
    text["accessors"][0]["count"] = count // 2
    text["meshes"] = [{**text["meshes"][0], "name": f"mesh {number}"} for number in range(1000)]
    (tmp_path / "any.glb").write_bytes(file_of(text, content[20 + struct.unpack_from("<I", content, 12)[0] :]))
    tracemalloc.start()
    try:
        with pytest.raises(DataError, match="accessors of more than"):
            read_glb(tmp_path / "any.glb")
        assert tracemalloc.get_traced_memory()[1] < 8 << 20
    finally:
        tracemalloc.stop()


def test_a_text_of_gigabytes_is_not_parsed(tmp_path, monkeypatch):
    monkeypatch.setattr(glb, "_LARGEST_TEXT", 100)
    (tmp_path / "any.glb").write_bytes(GOOD)
    with pytest.raises(DataError, match="a JSON part of"):
        read_glb(tmp_path / "any.glb")
