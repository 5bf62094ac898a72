"""Reads and writes the head asset, ``head.glb``: plain arrays in, plain arrays out."""

from __future__ import annotations

import json
import struct
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats, Indices
from agentface.errors import DataError, Fault

Array = npt.NDArray[Any]

_COMPONENTS: dict[int, type[np.generic]] = {
    5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32, 5122: np.int16, 5120: np.int8,
}  # fmt: skip
_CODES = {np.dtype(kind): code for code, kind in _COMPONENTS.items()}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_TYPES = {width: name for name, width in _WIDTHS.items()}
_LARGEST = 64 * 1024 * 1024
_LARGEST_STRIDE = 252
_HEADER = 20


@dataclass(slots=True)
class Shape:
    """A sparse morph target: ``offsets`` ``(N, 3)`` in metres at the vertices ``indices`` ``(N,)``."""

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


def read_glb(path: Path) -> dict[str, MeshArrays]:
    """The meshes of a GLB file by name; raises DataError when it is unreadable."""
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
        self.blob = content[_HEADER + length + 8 :]

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
        sparse = self.document["accessors"][index]["sparse"]
        where, values = sparse["indices"], sparse["values"]
        kind = np.dtype(_COMPONENTS[where["componentType"]])
        indices = self.view(where["bufferView"], where.get("byteOffset", 0), kind, sparse["count"])
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


def write_glb(path: Path, meshes: dict[str, MeshArrays], copyright_line: str) -> None:
    """Write meshes as one GLB file, morph targets as sparse accessors."""
    import pygltflib as gl

    document = gl.GLTF2(asset=gl.Asset(version="2.0", generator="agentface", copyright=copyright_line))
    blob = bytearray()

    def put(array: Array) -> int:
        blob.extend(b"\0" * (-len(blob) % 4))
        document.bufferViews.append(gl.BufferView(buffer=0, byteOffset=len(blob), byteLength=array.nbytes))
        blob.extend(np.ascontiguousarray(array).tobytes())
        return len(document.bufferViews) - 1

    def accessor(array: Array, *, bounds: bool = False) -> int:
        width = 1 if array.ndim == 1 else array.shape[1]
        row = gl.Accessor(
            bufferView=put(array), componentType=_CODES[array.dtype], count=len(array), type=_TYPES[width],
            normalized=array.dtype in (np.uint8, np.uint16) and width > 1,
        )  # fmt: skip
        if bounds:
            row.min, row.max = array.min(0).tolist(), array.max(0).tolist()
        document.accessors.append(row)
        return len(document.accessors) - 1

    def target(shape: Shape, count: int) -> dict[str, int]:
        row = gl.Accessor(componentType=gl.FLOAT, count=count, type="VEC3")
        row.min, row.max = shape.offsets.min(0).tolist(), shape.offsets.max(0).tolist()
        row.sparse = gl.Sparse(
            count=len(shape.indices),
            indices=gl.AccessorSparseIndices(
                bufferView=put(shape.indices.astype(np.uint16)), componentType=gl.UNSIGNED_SHORT
            ),
            values=gl.AccessorSparseValues(bufferView=put(shape.offsets.astype(np.float32))),
        )
        document.accessors.append(row)
        return {"POSITION": len(document.accessors) - 1}

    for name, mesh in meshes.items():
        count = len(mesh.attributes["POSITION"])
        attributes = gl.Attributes()
        for key, array in mesh.attributes.items():
            setattr(attributes, key, accessor(array, bounds=key == "POSITION"))
        primitive = gl.Primitive(attributes=attributes, indices=accessor(mesh.triangles.astype(np.uint16).ravel()))
        primitive.targets = [target(shape, count) for shape in mesh.shapes.values()]
        extras = {**mesh.extras, "targetNames": list(mesh.shapes)} if mesh.shapes else dict(mesh.extras)
        document.meshes.append(gl.Mesh(name=name, primitives=[primitive], extras=extras))
        document.nodes.append(gl.Node(mesh=len(document.meshes) - 1, name=name))
    document.scenes.append(gl.Scene(nodes=list(range(len(document.nodes)))))
    document.scene = 0
    blob.extend(b"\0" * (-len(blob) % 4))
    document.buffers.append(gl.Buffer(byteLength=len(blob)))
    document.set_binary_blob(bytes(blob))
    document.save_binary(str(path))
