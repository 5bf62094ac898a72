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

from agentface.conventions import Floats, Indices
from agentface.errors import DataError, Fault, InvalidValueError
from agentface.mesh.gltf_buffer import CHUNK, COMPONENTS, HEADER, WIDTHS, Array, GltfBuffer

_LARGEST = 64 * 1024 * 1024
_LARGEST_TEXT = 4 * 1024 * 1024
_MOST_READ = 4 * _LARGEST
"""Bytes that a file's accessors may come to: several can be of the same bytes."""
_LARGEST_STRIDE = 252


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
    except (ArithmeticError, AttributeError, LookupError, RecursionError, TypeError, ValueError, struct.error) as error:
        got = f"{type(error).__name__}: {error}"
        raise DataError([Fault(path, None, "", "a GLB file as agentface writes it", got)]) from error


class _GlbReader:
    """Reads the little of glTF that the asset uses; pygltflib takes a second for it, this a few milliseconds."""

    def __init__(self, content: bytes) -> None:
        magic, version, _, length, kind = struct.unpack_from("<4sIII4s", content)
        if (magic, version, kind) != (b"glTF", 2, b"JSON"):
            raise ValueError("not a binary glTF 2.0 file")
        if length > _LARGEST_TEXT:
            raise ValueError(f"a JSON part of {length} bytes, more than {_LARGEST_TEXT}")
        self.document: dict[str, Any] = json.loads(content[HEADER : HEADER + length])
        self.blob = content[HEADER + length + CHUNK :]
        self._read = 0

    def rows(self, index: int, offset: int, kind: np.dtype[Any], shape: tuple[int, int]) -> Array:
        """``shape`` components of a view whose rows may be interleaved with others, or padded to four bytes."""
        view, size = self._view(index), shape[1] * kind.itemsize
        stride, start = view.get("byteStride", size), view.get("byteOffset", 0) + offset
        if stride == size:
            return self.view(index, offset, kind, shape[0] * shape[1]).reshape(shape)
        if not size < stride <= _LARGEST_STRIDE or not 0 <= start <= len(self.blob) - stride * (shape[0] - 1) - size:
            raise ValueError(f"{shape[0]} rows of {stride} bytes in a view of fewer")
        self._count(shape[0] * size)
        return np.ndarray(shape, kind, self.blob, start, (stride, kind.itemsize)).copy()

    def view(self, index: int, offset: int, kind: np.dtype[Any], count: int) -> Array:
        if count < 0 or offset < 0:  # which mean something else to numpy
            raise ValueError(f"{count} components from byte {offset} on")
        self._count(count * kind.itemsize)
        return np.frombuffer(self.blob, kind, count, self._view(index).get("byteOffset", 0) + offset)

    def _count(self, size: int) -> None:
        self._read += size
        if self._read > _MOST_READ:
            raise ValueError(f"accessors of more than {_MOST_READ} bytes")

    def _view(self, index: int) -> dict[str, Any]:
        return _piece(self.document["bufferViews"], index)

    def accessor(self, index: int) -> Array:
        row = _piece(self.document["accessors"], index)
        width, kind = WIDTHS[row["type"]], np.dtype(COMPONENTS[row["componentType"]])
        found = self.rows(row["bufferView"], row.get("byteOffset", 0), kind, (row["count"], width))
        return found if width > 1 else found[:, 0]

    def shape(self, index: int) -> Shape:
        row = _piece(self.document["accessors"], index)
        if "sparse" not in row:
            return Shape(np.zeros(0, np.int32), np.zeros((0, 3), np.float32))
        sparse = row["sparse"]
        where, values = sparse["indices"], sparse["values"]
        kind = np.dtype(COMPONENTS[where["componentType"]])
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


def _piece(pieces: list[dict[str, Any]], index: int) -> dict[str, Any]:
    if not 0 <= index < len(pieces):  # -1 means another one to Python
        raise IndexError(f"number {index} of {len(pieces)}")
    return pieces[index]


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


class _Writer(GltfBuffer):
    """The meshes of an asset, a node each."""

    def __init__(self, copyright_line: str) -> None:
        super().__init__()
        self.meshes: list[dict[str, Any]] = []
        self.asset = {"version": "2.0", "generator": "agentface", "copyright": copyright_line}

    def content(self) -> bytes:
        nodes = [{"mesh": number, "name": mesh["name"]} for number, mesh in enumerate(self.meshes)]
        return self.binary(
            {
                "asset": self.asset,
                "scene": 0,
                "scenes": [{"nodes": list(range(len(nodes)))}],
                "nodes": nodes,
                "meshes": self.meshes,
            }
        )

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
            primitive["targets"] = [
                {"POSITION": self.sparse(f"shape {key}", shape.indices, shape.offsets, vertices)}
                for key, shape in mesh.shapes.items()
            ]
            extras["targetNames"] = list(mesh.shapes)
        self.meshes.append({"name": name, "primitives": [primitive], **({"extras": extras} if extras else {})})
