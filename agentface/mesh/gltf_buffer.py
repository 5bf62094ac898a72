"""The binary part of a glTF file: arrays become buffer views and accessors, and all of it one GLB file.

Source: Khronos Group, glTF 2.0 Specification (ISO/IEC 12113:2022), chapters 3.6 (buffers, accessors, sparse accessors)
and 4 (GLB).
"""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats, Indices
from agentface.errors import InvalidValueError

Array = npt.NDArray[Any]

COMPONENTS: dict[int, type[np.generic]] = {
    5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32, 5122: np.int16, 5120: np.int8,
}  # fmt: skip
"""The kinds of numbers by glTF's code."""
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
HEADER, CHUNK = 20, 8
"""Bytes before the JSON of a GLB file, and before its binary part."""
_CODES = {np.dtype(kind): code for code, kind in COMPONENTS.items()}
_TYPES = {width: name for name, width in WIDTHS.items()}
_ATTRIBUTES = frozenset(_CODES) - {np.dtype(np.uint32)}
_WIDEST_ATTRIBUTE = 4
_ARRAY_BUFFER, _ELEMENT_ARRAY_BUFFER = 34962, 34963


class GltfBuffer:
    """Takes arrays in and gives accessors, by number; the same arrays in the same order give the same bytes.

    Raises InvalidValueError for arrays that glTF cannot hold.
    """

    def __init__(self) -> None:
        self.accessors: list[dict[str, Any]] = []
        self.views: list[dict[str, Any]] = []
        self._blob = bytearray()

    def binary(self, document: Mapping[str, Any]) -> bytes:
        """The GLB file of a glTF document without buffers, to which these are added."""
        document = {
            **document,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": len(self._blob)}],
        }
        text = json.dumps(document, separators=(",", ":"), ensure_ascii=False, allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        binary = bytes(self._blob)
        size = HEADER + len(text) + CHUNK + len(binary)
        header = struct.pack("<4sIII4s", b"glTF", 2, size, len(text), b"JSON")
        return header + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary

    def view(self, raw: bytes, **properties: int) -> int:
        """A buffer view of these bytes."""
        self.views.append({"buffer": 0, "byteOffset": len(self._blob), "byteLength": len(raw), **properties})
        self._blob += raw + b"\0" * (-len(raw) % 4)
        return len(self.views) - 1

    def accessor(self, **properties: Any) -> int:
        """An accessor of these properties."""
        self.accessors.append(properties)
        return len(self.accessors) - 1

    def attribute(self, name: str, array: Array) -> int:
        """A vertex attribute ``(V,)`` or ``(V, 1..4)``: float32, or whole numbers of 8 or 16 bits.

        Unsigned ones stand for 0..1 where there are several a vertex, but ``JOINTS_0``.
        """
        width = 1 if array.ndim == 1 else array.shape[-1]
        if array.ndim > 2 or not 1 <= width <= _WIDEST_ATTRIBUTE or array.dtype not in _ATTRIBUTES or not len(array):
            expected = "rows of one to four float32, or whole numbers of 8 or 16 bits"
            raise InvalidValueError(name, expected, f"{array.dtype} of shape {array.shape}")
        rows = array.reshape(len(array), width)
        size = width * array.itemsize
        stride = size + -size % 4  # every vertex begins at a multiple of four bytes
        padded = np.zeros((len(rows), stride), np.uint8)
        padded[:, :size] = np.ascontiguousarray(rows).view(np.uint8)
        strided = {} if stride == size else {"byteStride": stride}
        properties: dict[str, Any] = {"bufferView": self.view(padded.tobytes(), target=_ARRAY_BUFFER, **strided)}
        properties |= {"componentType": _CODES[array.dtype], "count": len(array), "type": _TYPES[width]}
        if array.dtype in (np.uint8, np.uint16) and width > 1 and name != "JOINTS_0":
            properties["normalized"] = True
        if name == "POSITION":
            properties |= bounds(array)
        return self.accessor(**properties)

    def triangles(self, triangles: Indices, vertices: int) -> int:
        """The indices of ``triangles (T, 3)`` between so many vertices."""
        if not len(triangles) or not 0 <= triangles.min() <= triangles.max() < vertices:
            got = f"{triangles.min()} to {triangles.max()}" if len(triangles) else "no triangle"
            raise InvalidValueError("triangles", f"vertices in 0..{vertices - 1}", got)
        # the largest number of a type restarts a strip
        kind = np.dtype(np.uint16 if triangles.max() < np.iinfo(np.uint16).max else np.uint32)
        view = self.view(triangles.astype(kind).tobytes(), target=_ELEMENT_ARRAY_BUFFER)
        return self.accessor(bufferView=view, componentType=_CODES[kind], count=triangles.size, type="SCALAR")

    def sparse(self, name: str, indices: Indices, offsets: Floats, vertices: int) -> int:
        """``(vertices, 3)`` float32, 0 but for ``offsets (N, 3)`` at rising ``indices (N,)``."""
        offsets = offsets.astype(np.float32)
        properties = {"componentType": _CODES[offsets.dtype], "count": vertices, "type": "VEC3"}
        if not len(indices):
            return self.accessor(**properties, **bounds(np.zeros((1, 3), np.float32)))
        if not 0 <= indices[0] <= indices[-1] < vertices or (np.diff(indices) <= 0).any():
            raise InvalidValueError(name, f"rising vertices in 0..{vertices - 1}", "others")
        kind = np.dtype(np.uint16 if indices[-1] <= np.iinfo(np.uint16).max else np.uint32)
        properties["sparse"] = {
            "count": len(indices),
            "indices": {"bufferView": self.view(indices.astype(kind).tobytes()), "componentType": _CODES[kind]},
            "values": {"bufferView": self.view(offsets.tobytes())},
        }
        at_rest = np.zeros((int(len(indices) < vertices), 3), np.float32)
        return self.accessor(**properties, **bounds(np.concatenate([offsets, at_rest])))

    def numbers(self, array: Floats) -> int:
        """Rows ``(N,)`` or ``(N, k)`` of float32 that are no attribute: keyframes, matrices; with their bounds."""
        width = 1 if array.ndim == 1 else array.shape[-1]
        rows = np.ascontiguousarray(array, np.float32).reshape(-1, width)
        limits = bounds(rows) if width <= _WIDEST_ATTRIBUTE else {}
        return self.accessor(
            bufferView=self.view(rows.tobytes()),
            componentType=_CODES[rows.dtype],
            count=len(rows),
            type=_TYPES[width],
            **limits,
        )


def bounds(rows: Array) -> dict[str, list[float]]:
    """The properties ``min`` and ``max`` of an accessor."""
    return {"min": rows.min(0).tolist(), "max": rows.max(0).tolist()}
