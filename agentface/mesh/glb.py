"""Reads and writes the head asset, ``head.glb``: plain arrays in, plain arrays out.

Source: Khronos Group, glTF 2.0 Specification (ISO/IEC 12113:2022), chapters 3.6 (buffers, accessors, sparse accessors),
3.7 (meshes, morph targets) and 4 (GLB).
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats, Indices
from agentface.errors import DataError, Fault, InvalidValueError

Array = npt.NDArray[Any]

_COMPONENTS: dict[int, type[np.generic]] = {
    5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32, 5122: np.int16, 5120: np.int8,
}  # fmt: skip
_CODES = {np.dtype(kind): code for code, kind in _COMPONENTS.items()}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_TYPES = {width: name for name, width in _WIDTHS.items()}
_ATTRIBUTES = frozenset(_CODES) - {np.dtype(np.uint32)}
_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963
_LARGEST = 64 * 1024 * 1024
_LARGEST_STRIDE = 252
_HEADER = 20
_CHUNK = 8


@dataclass(slots=True)
class Shape:
    """A sparse morph target: ``offsets`` ``(N, 3)`` in metres at the vertices ``indices`` ``(N,)``, in rising order."""

    indices: Indices
    offsets: Floats

    def dense(self, vertex_count: int) -> Floats:
        """The offsets of all vertices, ``(V, 3)``."""
        field_ = np.zeros((vertex_count, 3), np.float32)
        field_[self.indices] = self.offsets
        return field_


@dataclass(slots=True)
class MeshArrays:
    """One mesh of the asset: triangles, vertex attributes by their glTF name, morph targets by name, extras."""

    triangles: Indices
    attributes: dict[str, Array]
    shapes: dict[str, Shape] = field(default_factory=dict)
    extras: dict[str, Any] = field(default_factory=dict)


def read_glb(path: str | Path) -> dict[str, MeshArrays]:
    """The meshes of a GLB file by name; raises DataError when it is unreadable."""
    path = Path(path)
    try:
        if path.stat().st_size > _LARGEST:
            raise DataError([Fault(path, None, "", f"at most {_LARGEST} bytes", f"{path.stat().st_size}")])
        reader = _GlbReader(path.read_bytes())
        return {mesh["name"]: reader.mesh(mesh) for mesh in reader.document["meshes"]}
    except OSError as error:
        raise DataError([Fault(path, None, "", "a readable file", error.strerror or "an error")]) from None
    except (ValueError, KeyError, IndexError, TypeError, RecursionError, struct.error) as error:
        got = f"{type(error).__name__}: {error}"
        raise DataError([Fault(path, None, "", "a GLB file as agentface writes it", got)]) from error


class _GlbReader:
    """Reads the little of glTF that the asset uses; pygltflib takes a second for it, this a few milliseconds."""

    def __init__(self, content: bytes) -> None:
        magic, version, _, length, kind = struct.unpack_from("<4sIII4s", content)
        if (magic, version, kind) != (b"glTF", 2, b"JSON"):
            raise ValueError("not a binary glTF 2.0 file")
        self.document: dict[str, Any] = json.loads(content[_HEADER : _HEADER + length])
        self.blob = content[_HEADER + length + _CHUNK :]

    def rows(self, index: int, offset: int, kind: np.dtype[Any], shape: tuple[int, int]) -> Array:
        """``shape`` components of a view whose rows may be interleaved with others, or padded to four bytes."""
        view, size = self.document["bufferViews"][index], shape[1] * kind.itemsize
        stride, start = view.get("byteStride", size), view.get("byteOffset", 0) + offset
        if stride == size:
            return self.view(index, offset, kind, shape[0] * shape[1]).reshape(shape)
        if not size < stride <= _LARGEST_STRIDE or not 0 <= start <= len(self.blob) - stride * (shape[0] - 1) - size:
            raise ValueError(f"{shape[0]} rows of {stride} bytes in a view of fewer")
        return np.ndarray(shape, kind, self.blob, start, (stride, kind.itemsize)).copy()

    def view(self, index: int, offset: int, kind: np.dtype[Any], count: int) -> Array:
        start = self.document["bufferViews"][index].get("byteOffset", 0)
        return np.frombuffer(self.blob, kind, count, start + offset)

    def accessor(self, index: int) -> Array:
        row = self.document["accessors"][index]
        width, kind = _WIDTHS[row["type"]], np.dtype(_COMPONENTS[row["componentType"]])
        found = self.rows(row["bufferView"], row.get("byteOffset", 0), kind, (row["count"], width))
        return found if width > 1 else found[:, 0]

    def shape(self, index: int) -> Shape:
        row = self.document["accessors"][index]
        if "sparse" not in row:
            return Shape(np.zeros(0, np.int32), np.zeros((0, 3), np.float32))
        sparse = row["sparse"]
        where, values = sparse["indices"], sparse["values"]
        kind = np.dtype(_COMPONENTS[where["componentType"]])
        indices = self.view(where["bufferView"], where.get("byteOffset", 0), kind, sparse["count"])
        if len(indices) and not 0 <= indices.min() <= indices.max() < row["count"]:
            raise ValueError(f"a morph target of {row['count']} vertices that moves vertex {indices.max()}")
        single = np.dtype(np.float32)
        offsets = self.view(values["bufferView"], values.get("byteOffset", 0), single, sparse["count"] * 3)
        return Shape(indices.astype(np.int32), offsets.reshape(-1, 3))

    def mesh(self, mesh: dict[str, Any]) -> MeshArrays:
        primitive, extras = mesh["primitives"][0], mesh.get("extras") or {}
        targets = [self.shape(target["POSITION"]) for target in primitive.get("targets") or []]
        return MeshArrays(
            self.accessor(primitive["indices"]).reshape(-1, 3).astype(np.int32),
            {name: self.accessor(at) for name, at in primitive["attributes"].items()},
            dict(zip(extras.get("targetNames", []), targets, strict=True)),
            extras,
        )


def texture_coordinates(mesh: MeshArrays) -> Floats | None:
    """The mesh's TEXCOORD_0 as float32, None where it has none; glTF's whole numbers stand for 0..1."""
    found = mesh.attributes.get("TEXCOORD_0")
    if found is None or found.dtype == np.float32:
        return found
    return found.astype(np.float32) / np.float32(np.iinfo(found.dtype).max)


def write_glb(path: str | Path, meshes: Mapping[str, MeshArrays], copyright_line: str) -> None:
    """Write meshes as one GLB file; raises what :func:`encode_glb` raises, and OSError."""
    path = Path(path)
    path.write_bytes(encode_glb(meshes, copyright_line))


def encode_glb(meshes: Mapping[str, MeshArrays], copyright_line: str) -> bytes:
    """Meshes as a GLB file, one node each, morph targets as sparse accessors; the same meshes give the same bytes.

    Attributes are float32, or whole numbers of 8 or 16 bits; a mesh may have more than 65 535 vertices.
    Raises InvalidValueError for arrays that glTF cannot hold.
    """
    writer = _Writer(copyright_line)
    for name, mesh in meshes.items():
        writer.mesh(name, mesh)
    return writer.content()


class _Writer:
    def __init__(self, copyright_line: str) -> None:
        self.blob = bytearray()
        self.accessors: list[dict[str, Any]] = []
        self.views: list[dict[str, Any]] = []
        self.meshes: list[dict[str, Any]] = []
        self.asset = {"version": "2.0", "generator": "agentface", "copyright": copyright_line}

    def content(self) -> bytes:
        nodes = [{"mesh": number, "name": mesh["name"]} for number, mesh in enumerate(self.meshes)]
        document = {
            "asset": self.asset,
            "scene": 0,
            "scenes": [{"nodes": list(range(len(nodes)))}],
            "nodes": nodes,
            "meshes": self.meshes,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self.blob)}],
        }
        text = json.dumps(document, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self.blob)
        size = _HEADER + len(text) + _CHUNK + len(binary)
        header = struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON")
        return header + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary

    def view(self, array: Array, **properties: int) -> int:
        raw = np.ascontiguousarray(array).tobytes()
        self.views.append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": len(raw), **properties})
        self.blob += raw + b"\0" * (-len(raw) % 4)
        return len(self.views) - 1

    def accessor(self, **properties: Any) -> int:
        self.accessors.append(properties)
        return len(self.accessors) - 1

    def attribute(self, name: str, array: Array) -> int:
        width = 1 if array.ndim == 1 else array.shape[-1]
        if array.ndim > 2 or width not in _TYPES or array.dtype not in _ATTRIBUTES or not len(array):
            expected = "rows of one to four float32, or whole numbers of 8 or 16 bits"
            raise InvalidValueError(name, expected, f"{array.dtype} of shape {array.shape}")
        rows = array.reshape(len(array), width)
        size = width * array.itemsize
        stride = size + -size % 4  # every vertex begins at a multiple of four bytes
        padded = np.zeros((len(rows), stride), np.uint8)
        padded[:, :size] = np.ascontiguousarray(rows).view(np.uint8)
        strided = {} if stride == size else {"byteStride": stride}
        properties: dict[str, Any] = {"bufferView": self.view(padded, target=_ARRAY_BUFFER, **strided)}
        properties |= {"componentType": _CODES[array.dtype], "count": len(array), "type": _TYPES[width]}
        if array.dtype in (np.uint8, np.uint16) and width > 1:
            properties["normalized"] = True
        if name == "POSITION":
            properties |= _bounds(array)
        return self.accessor(**properties)

    def triangles(self, triangles: Indices, vertices: int) -> int:
        if not len(triangles) or not 0 <= triangles.min() <= triangles.max() < vertices:
            got = f"{triangles.min()} to {triangles.max()}" if len(triangles) else "no triangle"
            raise InvalidValueError("triangles", f"vertices in 0..{vertices - 1}", got)
        # the largest number of a type restarts a strip
        kind = np.dtype(np.uint16 if triangles.max() < np.iinfo(np.uint16).max else np.uint32)
        view = self.view(triangles.astype(kind).ravel(), target=_ELEMENT_ARRAY_BUFFER)
        return self.accessor(bufferView=view, componentType=_CODES[kind], count=triangles.size, type="SCALAR")

    def target(self, name: str, shape: Shape, vertices: int) -> dict[str, int]:
        indices, offsets = shape.indices, shape.offsets.astype(np.float32)
        properties = {"componentType": _CODES[offsets.dtype], "count": vertices, "type": "VEC3"}
        if not len(indices):
            zero = np.zeros((1, 3), np.float32)
            return {"POSITION": self.accessor(**properties, **_bounds(zero))}
        if not 0 <= indices[0] <= indices[-1] < vertices or (np.diff(indices) <= 0).any():
            raise InvalidValueError(f"shape {name}", f"rising vertices in 0..{vertices - 1}", "others")
        kind = np.dtype(np.uint16 if indices[-1] <= np.iinfo(np.uint16).max else np.uint32)
        properties["sparse"] = {
            "count": len(indices),
            "indices": {"bufferView": self.view(indices.astype(kind)), "componentType": _CODES[kind]},
            "values": {"bufferView": self.view(offsets)},
        }
        at_rest = np.zeros((int(len(indices) < vertices), 3), np.float32)
        return {"POSITION": self.accessor(**properties, **_bounds(np.concatenate([offsets, at_rest])))}

    def mesh(self, name: str, mesh: MeshArrays) -> None:
        vertices = len(mesh.attributes["POSITION"])
        if any(len(array) != vertices for array in mesh.attributes.values()):
            lengths = ", ".join(f"{key} {len(array)}" for key, array in mesh.attributes.items())
            raise InvalidValueError(name, "attributes with one row a vertex", lengths)
        primitive: dict[str, Any] = {
            "attributes": {key: self.attribute(key, array) for key, array in mesh.attributes.items()},
            "indices": self.triangles(mesh.triangles, vertices),
        }
        extras = dict(mesh.extras)
        if mesh.shapes:
            primitive["targets"] = [self.target(key, shape, vertices) for key, shape in mesh.shapes.items()]
            extras["targetNames"] = list(mesh.shapes)
        self.meshes.append({"name": name, "primitives": [primitive], **({"extras": extras} if extras else {})})


def _bounds(rows: Array) -> dict[str, list[float]]:
    return {"min": rows.min(0).tolist(), "max": rows.max(0).tolist()}
