"""GLB files: what is written is what Khronos' validator, an independent reader and our own reader take it for."""

from __future__ import annotations

import json
import struct
import subprocess
import sys

import numpy as np
import pygltflib
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from agentface.errors import DataError, InvalidValueError
from agentface.mesh.glb import MeshArrays, Shape, encode_glb, read_glb, write_glb
from agentface.resources import face_folder, face_names
from tests.gltf_validator import issues

KINDS = (np.uint8, np.int8, np.uint16, np.int16, np.float32)


def document(content: bytes) -> dict:
    length = struct.unpack_from("<I", content, 12)[0]
    return json.loads(content[20 : 20 + length])


def fan(vertices: int, **attributes: np.ndarray) -> MeshArrays:
    """A fan of triangles round the first vertex that uses every vertex."""
    turn = np.linspace(0, 6, vertices, dtype=np.float32)
    rim = np.arange(1, vertices - 1)
    return MeshArrays(
        np.stack([0 * rim, rim, rim + 1], 1).astype(np.int32),
        {"POSITION": np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1), **attributes},
    )


def moving(*vertices: int) -> MeshArrays:
    mesh = fan(5)
    mesh.shapes["moved"] = Shape(np.array(vertices, np.int32), np.ones((len(vertices), 3), np.float32))
    return mesh


def same(first: MeshArrays, second: MeshArrays) -> None:
    np.testing.assert_array_equal(first.triangles, second.triangles)
    assert list(first.attributes) == list(second.attributes)
    for key, array in first.attributes.items():
        assert array.dtype == second.attributes[key].dtype
        np.testing.assert_array_equal(array, second.attributes[key])
    assert list(first.shapes) == list(second.shapes)
    for key, shape in first.shapes.items():
        np.testing.assert_array_equal(shape.indices, second.shapes[key].indices)
        np.testing.assert_array_equal(shape.offsets, second.shapes[key].offsets)


def test_the_validator_finds_nothing_in_the_shipped_faces():
    files = [face_folder(face) / "head.glb" for face in face_names()]
    assert issues(*files) == {str(file): [] for file in files}


def test_the_validator_finds_nothing_in_any_kind_of_mesh(tmp_path):
    large = fan(70_000)
    large.shapes["far"] = Shape(np.array([3, 69_999], np.int32), np.ones((2, 3), np.float32))
    every = np.arange(9, dtype=np.int32)
    small = fan(
        9,
        _NARROW=every.astype(np.uint16),
        _BYTES=np.ones((9, 3), np.uint8),
        TEXCOORD_0=np.linspace(0, 65535, 18).reshape(9, 2).astype(np.uint16),
    )
    small.shapes |= {"none": Shape(every[:0], np.zeros((0, 3), np.float32)), "all": Shape(every, np.ones((9, 3), "f4"))}
    small.extras["name"] = "Grüße"
    path = tmp_path / "any.glb"
    write_glb(path, {"large": large, "small": small, "edge": fan(65_535), "over": fan(65_536)}, "© nobody")
    unused = "/meshes/1/primitives/0/attributes/TEXCOORD_0: This object may be unused."  # it has no material
    assert issues(path) == {str(path): [f"information UNUSED_OBJECT {unused}"]}
    again = read_glb(path)
    same(again["large"], large)
    same(again["small"], small)
    assert again["small"].extras["name"] == "Grüße"
    kinds = [document(path.read_bytes())["accessors"][m["primitives"][0]["indices"]]["componentType"]
             for m in document(path.read_bytes())["meshes"]]  # fmt: skip
    assert kinds == [5125, 5123, 5123, 5125]


def test_the_validator_would_find_a_fault(tmp_path):
    content = (face_folder("amber") / "head.glb").read_bytes()
    wrong = content.replace(b'"max":[0.0', b'"max":[9.0', 1)
    (tmp_path / "wrong.glb").write_bytes(wrong)
    (found,) = issues(tmp_path / "wrong.glb").values()
    assert any(issue.startswith("error ACCESSOR_MAX_MISMATCH /accessors/0/max/0") for issue in found)


@pytest.mark.parametrize("face", face_names())
def test_an_independent_reader_reads_the_same(face):
    path = face_folder(face) / "head.glb"
    other, meshes = pygltflib.GLTF2.load_binary(str(path)), read_glb(path)
    blob = other.binary_blob()

    def raw(view: int, kind: type, width: int) -> np.ndarray:
        start, size = other.bufferViews[view].byteOffset, other.bufferViews[view].byteLength
        return np.frombuffer(blob[start : start + size], kind).reshape(-1, width)

    assert [mesh.name for mesh in other.meshes] == [other.nodes[node].name for node in other.scenes[0].nodes]
    for mesh in other.meshes:
        primitive, ours = mesh.primitives[0], meshes[mesh.name]
        triangles = other.accessors[primitive.indices]
        np.testing.assert_array_equal(raw(triangles.bufferView, np.uint16, 3), ours.triangles)
        positions = other.accessors[primitive.attributes.POSITION]
        np.testing.assert_array_equal(raw(positions.bufferView, np.float32, 3), ours.attributes["POSITION"])
        names = (mesh.extras or {}).get("targetNames", [])
        for name, target in zip(names, primitive.targets or [], strict=True):
            accessor = other.accessors[target["POSITION"]]
            sparse = accessor.sparse
            dense = np.zeros((accessor.count, 3), np.float32)
            dense[raw(sparse.indices.bufferView, np.uint16, 1)[:, 0]] = raw(sparse.values.bufferView, np.float32, 3)
            np.testing.assert_array_equal(dense, ours.shapes[name].dense(accessor.count))
            np.testing.assert_array_equal([accessor.min, accessor.max], [dense.min(0), dense.max(0)])


@pytest.mark.parametrize("face", face_names())
def test_a_shipped_face_is_what_its_own_meshes_are_written_as(face):
    content = (face_folder(face) / "head.glb").read_bytes()
    credit = document(content)["asset"]["copyright"]
    assert encode_glb(read_glb(face_folder(face) / "head.glb"), credit) == content


@settings(max_examples=40)
@given(st.data(), st.integers(3, 12), st.sampled_from(KINDS), st.integers(1, 4))
def test_what_is_written_is_read_back(tmp_path_factory, data, vertices, kind, width):
    shape = (vertices, width) if width > 1 else (vertices,)
    bits = data.draw(arrays(np.uint8, (vertices, width * np.dtype(kind).itemsize)))
    attribute = bits.view(kind).reshape(shape) if kind is not np.float32 else data.draw(arrays(np.float32, shape))
    moved = np.array(sorted(data.draw(st.sets(st.integers(0, vertices - 1)))), np.int32)
    mesh = fan(vertices, _ANY=attribute)
    mesh.shapes["moved"] = Shape(
        moved, data.draw(arrays(np.float32, (len(moved), 3), elements=st.floats(-1, 1, width=32)))
    )
    path = tmp_path_factory.mktemp("glb") / "mesh.glb"
    write_glb(path, {"mesh": mesh}, "")
    same(read_glb(path)["mesh"], mesh)
    content = path.read_bytes()
    assert struct.unpack_from("<4sII", content) == (b"glTF", 2, len(content))
    assert all(view["byteOffset"] % 4 == 0 for view in document(content)["bufferViews"])


@pytest.mark.parametrize(
    ("mesh", "message"),
    [
        (fan(5, _NUMBER=np.zeros(5, np.uint32)), "_NUMBER: expected rows of one to four float32"),
        (fan(5, _WIDE=np.zeros((5, 5), np.float32)), "_WIDE: expected rows of one to four"),
        (fan(5, _DOUBLE=np.zeros(5)), "float64"),
        (fan(5, _SHORT=np.zeros(4, np.float32)), "one row a vertex"),
        (MeshArrays(np.array([[0, 1, 5]], np.int32), fan(5).attributes), r"vertices in 0\.\.4"),
        (MeshArrays(np.zeros((0, 3), np.int32), fan(5).attributes), "no triangle"),
        (moving(2, 2), "shape moved: expected rising"),
        (moving(2, 5), "shape moved: expected rising"),
    ],
)  # fmt: skip
def test_what_gltf_cannot_hold_is_refused(tmp_path, mesh, message):
    with pytest.raises(InvalidValueError, match=message):
        write_glb(tmp_path / "refused.glb", {"mesh": mesh}, "")
    assert not (tmp_path / "refused.glb").exists()


def test_a_shape_off_the_mesh_is_one_fault(tmp_path):
    content = encode_glb({"mesh": moving(3)}, "")
    accessor = document(content)["accessors"][-1]
    view = document(content)["bufferViews"][accessor["sparse"]["indices"]["bufferView"]]
    start = len(content) - document(content)["buffers"][0]["byteLength"] + view["byteOffset"]
    (tmp_path / "off.glb").write_bytes(content[:start] + b"\x05\0" + content[start + 2 :])
    with pytest.raises(DataError, match="moves vertex 5"):
        read_glb(tmp_path / "off.glb")


def test_writing_needs_no_library():
    program = (
        "import sys; from agentface.mesh.glb import encode_glb, read_glb; from agentface.resources import face_folder; "
        "encode_glb(read_glb(face_folder('amber') / 'head.glb'), ''); print(*sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True, timeout=240)
    assert "pygltflib" not in run.stdout.split()
