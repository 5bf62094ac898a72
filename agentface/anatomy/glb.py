"""Reads and writes the head asset, ``head.glb``: plain arrays in, plain arrays out, through pygltflib."""

from __future__ import annotations

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
    import pygltflib

    try:
        if path.stat().st_size > _LARGEST:
            raise DataError([Fault(path, None, "", f"at most {_LARGEST} bytes", f"{path.stat().st_size}")])
        document = pygltflib.GLTF2.load_binary(str(path))
        reader = _Reader(document)
        return {mesh.name: reader.mesh(mesh) for mesh in document.meshes}
    except OSError as error:
        raise DataError([Fault(path, None, "", "a readable file", error.strerror or "an error")]) from None
    except (ValueError, KeyError, IndexError, TypeError, AttributeError) as error:
        raise DataError([Fault(path, None, "", "a GLB file as agentface writes it", f"{type(error).__name__}: {error}")]) from error


class _Reader:
    def __init__(self, document: Any) -> None:
        self.document = document
        self.blob = document.binary_blob()

    def view(self, index: int, offset: int, kind: np.dtype[Any], count: int) -> Array:
        view = self.document.bufferViews[index]
        return np.frombuffer(self.blob, kind, count, (view.byteOffset or 0) + (offset or 0))

    def accessor(self, index: int) -> Array:
        accessor = self.document.accessors[index]
        width, kind = _WIDTHS[accessor.type], np.dtype(_COMPONENTS[accessor.componentType])
        flat = self.view(accessor.bufferView, accessor.byteOffset, kind, accessor.count * width)
        return flat.reshape(accessor.count, width) if width > 1 else flat

    def shape(self, index: int) -> Shape:
        sparse = self.document.accessors[index].sparse
        kind = np.dtype(_COMPONENTS[sparse.indices.componentType])
        where = self.view(sparse.indices.bufferView, sparse.indices.byteOffset, kind, sparse.count)
        offsets = self.view(sparse.values.bufferView, sparse.values.byteOffset, np.dtype(np.float32), sparse.count * 3)
        return Shape(where.astype(np.int32), offsets.reshape(-1, 3))

    def mesh(self, mesh: Any) -> MeshArrays:
        primitive = mesh.primitives[0]
        names = {name: at for name, at in vars(primitive.attributes).items() if isinstance(at, int)}
        extras = mesh.extras or {}
        targets = (target["POSITION"] if isinstance(target, dict) else target.POSITION for target in primitive.targets or [])
        return MeshArrays(
            self.accessor(primitive.indices).reshape(-1, 3).astype(np.int32),
            {name: self.accessor(at) for name, at in names.items()},
            dict(zip(extras.get("targetNames", []), map(self.shape, targets), strict=True)),
            extras,
        )


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
            normalized=array.dtype == np.uint8 and width == 4,
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
            indices=gl.AccessorSparseIndices(bufferView=put(shape.indices.astype(np.uint16)), componentType=gl.UNSIGNED_SHORT),
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
