"""The head as a page takes it, in one binary glTF file: everything that a portrait is drawn from, and the basis.

Any viewer of glTF shows the skin at rest. The rest is in the extension ``AGENTFACE_face``, whose values name arrays by
``{"array": n}``: the n-th of its ``arrays``, each a view of the buffer with the ``type`` of its numbers, a ``shape``,
and a ``scale`` where what is stored stands for that many times itself.

Source: Khronos Group, glTF 2.0 Specification, chapters 2.7 (extensions) and 4 (GLB).
"""

from __future__ import annotations

import io
import json
import struct
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.deform import tables as deform_tables
from agentface.head.look import Look
from agentface.head.model import HeadModel
from agentface.io.web.basis import Basis
from agentface.view.portrait import portrait

EXTENSION = "AGENTFACE_face"
VERSION = 1
"""Of what the extension holds; a page refuses another."""
_UNIT = ("facing", "soft_normal", "rest_normal", "along_rest")
"""Fields of unit vectors, of which two bytes a number are enough."""
_WHOLE = 32767
_KINDS = {"f4": "f32", "i4": "i32", "u4": "u32", "i2": "i16", "u2": "u16", "i1": "i8", "u1": "u8"}
_SHORT = 65535


def encode_head(model: HeadModel, look: Look, basis: Basis) -> bytes:
    """The file of a face in a look, with the movements of ``basis``.

    The same arguments give the same bytes. Raises DataError as :func:`~agentface.head.skin_image.skin_image`.
    """
    drawn = portrait(model, look)
    buffer = _Buffer()
    record = {
        "version": VERSION,
        "face": model.name,
        "finish": _finish(model),
        "rest": {"vertices": model.vertices, "triangles": model.triangles},
        "basis": {"skin": basis.skin._asdict(), "tongue": basis.tongue._asdict()},
        **drawn,
        "picture": _png(drawn["picture"]),
    }
    extension = {**buffer.packed(record), "arrays": buffer.arrays}
    return _glb(_document(model, extension, buffer), bytes(buffer.content))


def _finish(model: HeadModel) -> dict[str, Any]:
    """The tables of the last stages that a page does itself."""
    tables = deform_tables.of(model).finish
    wrinkles, neck = tables.wrinkles, tables.neck
    return {
        "wrinkles": {"first": wrinkles.first, "vertices": wrinkles.vertices, "heights": wrinkles.heights},
        "neck": {"where": neck.where, "stays": neck.stays},
    }


class _Buffer:
    """The binary part, and what lies where in it."""

    def __init__(self) -> None:
        self.content = bytearray()
        self.views: list[dict[str, int]] = []
        self.arrays: list[dict[str, Any]] = []

    def packed(self, value: Any, name: str = "") -> Any:
        """``value`` with its arrays put away."""
        if isinstance(value, dict):
            return {key: self.packed(item, key) for key, item in value.items()}
        if isinstance(value, np.ndarray):
            return {"array": self._array(value, name)}
        if isinstance(value, bytes):
            return {"array": self._array(np.frombuffer(value, np.uint8), name)}
        if isinstance(value, (list, tuple)):
            return [self.packed(item, name) for item in value]
        return value.item() if isinstance(value, np.generic) else value

    def view(self, raw: bytes) -> int:
        self.views.append({"buffer": 0, "byteOffset": len(self.content), "byteLength": len(raw)})
        self.content += raw + b"\0" * (-len(raw) % 8)
        return len(self.views) - 1

    def _array(self, array: npt.NDArray[Any], name: str) -> int:
        stored, scale = _stored(array, name)
        row = {"view": self.view(stored.tobytes()), "type": _KINDS[stored.dtype.str[1:]], "shape": list(array.shape)}
        self.arrays.append(row if scale is None else row | {"scale": scale})
        return len(self.arrays) - 1


def _stored(array: npt.NDArray[Any], name: str) -> tuple[npt.NDArray[Any], float | None]:
    """The numbers as they are stored, little endian, and what one of them stands for where that is not 1."""
    if name in _UNIT:
        return np.rint(array * _WHOLE).astype("<i2"), 1.0 / _WHOLE
    if name == "heights" and array.ndim == 2:
        scale = float(array.max()) / _SHORT or 1.0
        return np.rint(array / scale).astype("<u2"), scale
    if array.dtype.kind == "f":
        return array.astype("<f4"), None
    if array.dtype.itemsize > 2 and array.size and array.min() >= 0 and array.max() <= _SHORT:
        return array.astype("<u2"), None
    return (array.astype("<i4") if array.dtype.itemsize > 4 else array), None


def _png(picture: npt.NDArray[np.uint8] | None) -> bytes | None:
    if picture is None:
        return None
    from PIL import Image

    stream = io.BytesIO()
    Image.fromarray(picture).save(stream, "PNG")
    return stream.getvalue()


def _document(model: HeadModel, extension: dict[str, Any], buffer: _Buffer) -> dict[str, Any]:
    rest = model.vertices
    places, corners = buffer.view(rest.astype("<f4").tobytes()), buffer.view(model.triangles.astype("<u4").tobytes())
    for view, target in ((places, 34962), (corners, 34963)):
        buffer.views[view]["target"] = target
    bounds = {"min": rest.min(0).tolist(), "max": rest.max(0).tolist()}
    return {
        "asset": {"version": "2.0", "generator": "agentface"},
        "extensionsUsed": [EXTENSION],
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": model.name}],
        "meshes": [{"name": "skin", "primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "accessors": [
            {"bufferView": places, "componentType": 5126, "count": len(rest), "type": "VEC3", **bounds},
            {"bufferView": corners, "componentType": 5125, "count": model.triangles.size, "type": "SCALAR"},
        ],
        "bufferViews": buffer.views,
        "buffers": [{"byteLength": len(buffer.content)}],
        "extensions": {EXTENSION: extension},
    }


def _glb(document: dict[str, Any], binary: bytes) -> bytes:
    text = json.dumps(document, separators=(",", ":"), allow_nan=False).encode()
    text += b" " * (-len(text) % 8 + 4)  # the binary part begins at a multiple of eight
    header = struct.pack("<4sIII4s", b"glTF", 2, 28 + len(text) + len(binary), len(text), b"JSON")
    return header + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
