""":class:`FrameWriter`: one frame of a face as a page gets it, by weights of its basis or by all of its vertices."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.deform.finish import chest
from agentface.deform.geometry import FaceGeometry
from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.io.web.basis import Basis, Projector
from agentface.io.web.layout import Field, Layout
from agentface.io.web.unfinished import Unfinished

Mode = Literal["basis", "exact"]
MODES: tuple[Mode, ...] = ("basis", "exact")
FRAME = 0
"""The first byte of a message that is a frame."""
_LARGE = {"skin": 28, "tongue": 14}
"""So many of the first weights have 16 bits; what the others move is seen no finer with more than 8."""
_UNIT = 1.0 / 32767
_EXACT = 4e-6  # m
_TURN_AND_MOVE = (_UNIT,) * 4 + (1e-5,) * 3
_SMALL_TURN_AND_MOVE = (_UNIT,) * 4 + (2e-6,) * 3


def basis_layout(basis: Basis, trains: int) -> Layout:
    """What a frame of weights holds: of the modes of ``basis``, and of so many trains of wrinkles."""
    counts = {"skin": len(basis.skin.scales), "tongue": len(basis.tongue.scales)}
    large = [Field(name, "i16", min(most, counts[name]), _UNIT) for name, most in _LARGE.items()]
    rests = {name: counts[name] - most for name, most in _LARGE.items()}
    small = [Field(name, "i8", rest, 1.0 / 127) for name, rest in rests.items() if rest > 0]
    return Layout([*_BEGINNING, *large, *_RIGID, *small, _BREATH, *_levels(trains)])


def exact_layout(skin: int, tongue: int, trains: int) -> Layout:
    """What a frame of vertices holds: so many of the skin, before its last stages, and of the tongue; of trains."""
    vertices = [Field("vertices", "i16", 3 * skin, _EXACT), Field("tongue_vertices", "i16", 3 * tongue, _EXACT)]
    rigid = [Field(field.name, "f32", field.count) for field in (*_RIGID, _BREATH)]
    return Layout([*_BEGINNING, *vertices, *rigid, *_levels(trains, "u16")])


_BEGINNING = (Field("frame", "u32"), Field("time_s", "f64"))
_RIGID = (
    Field("eyes", "i16", 8, _UNIT),
    Field("pupils", "i16", 2, 1e-4),
    Field("eye_thrust", "i16", 2, 1e-7),
    Field("jaw", "i16", 7, _SMALL_TURN_AND_MOVE),
    Field("head", "i16", 7, _TURN_AND_MOVE),
)

_BREATH = Field("breath", "u8", 1, 1.0 / 255)


def _levels(trains: int, kind: str = "u8") -> list[Field]:
    return [Field("wrinkle_levels", kind, trains, 1.0 / (255 if kind == "u8" else 65535))] if trains else []


class FrameWriter:
    """Writes the frames of one face.

    Args:
        model: the face.
        basis: its modes.

    Attributes:
        layouts: what a frame of each mode holds.
    """

    def __init__(self, model: HeadModel, basis: Basis) -> None:
        self._projector, self._unfinished = Projector(model, basis), Unfinished(model)
        self._at_rest = model.vertices, model.parts["tongue"].attributes["POSITION"]
        skin, tongue = (len(rest) for rest in self._at_rest)
        trains = len(model.trains)
        self.layouts: dict[Mode, Layout] = {
            "basis": basis_layout(basis, trains),
            "exact": exact_layout(skin, tongue, trains),
        }

    def write(self, mode: Mode, frame: int, time_s: float, geometry: FaceGeometry) -> bytes:
        """The message of one frame, whose number counts on from 0 and then anew: the byte ``FRAME``, the record."""
        values: dict[str, npt.ArrayLike] = {"frame": frame & 0xFFFFFFFF, "time_s": time_s}
        values |= rigid_values(geometry)
        if mode == "basis":
            values["skin"], values["tongue"] = self._projector.weights(geometry)
        else:
            values["vertices"] = self._unfinished.skin(geometry) - self._at_rest[0]
            values["tongue_vertices"] = geometry.tongue - self._at_rest[1]
        return bytes((FRAME,)) + self.layouts[mode].encode(values)


def rigid_values(geometry: FaceGeometry) -> dict[str, npt.ArrayLike]:
    """What moves as a whole, by the names of a frame's fields, and how far wrinkles have risen."""
    eyes, jaw, head = geometry.eye_rotations, geometry.jaw, geometry.head
    turns = quaternions(np.stack([eyes[0], eyes[1], jaw[:3, :3], head[:3, :3]]))
    return {
        "eyes": turns[:2],
        "pupils": geometry.pupils,
        "eye_thrust": geometry.eye_thrust,
        "jaw": np.append(turns[2], jaw[:3, 3]),
        "head": np.append(turns[3], head[:3, 3]),
        "breath": chest.breath_of(geometry.shoulders),
        "wrinkle_levels": geometry.wrinkle_levels,
    }


class FrameReader:
    """What a page does with frames, for tests and measurements: from a record back to ``vertices`` and ``tongue``.

    Args:
        model: the face.
        basis: its modes.
        layout: of the records.
    """

    def __init__(self, model: HeadModel, basis: Basis, layout: Layout) -> None:
        self._model, self._basis, self._layout = model, basis, layout
        self._unfinished = Unfinished(model)

    def read(self, message: bytes) -> tuple[Mapping[str, Doubles], npt.NDArray[Any], npt.NDArray[Any]]:
        """The values of a frame, and the vertices of skin ``(V, 3)`` and tongue ``(T, 3)`` in m, in the head's axes.

        Raises InvalidValueError for a message that is no frame.
        """
        if message[:1] != bytes((FRAME,)):
            raise InvalidValueError("message", f"a frame, which begins with {FRAME}", message[:1])
        values = self._layout.decode(message[1:])
        moves: tuple[npt.NDArray[Any], npt.NDArray[Any]]
        skin, tongue = self._model.vertices, self._model.parts["tongue"].attributes["POSITION"]
        if "vertices" in values:
            moves = values["vertices"].reshape(-1, 3), values["tongue_vertices"].reshape(-1, 3)
        else:
            weights = [values[name].astype(np.float32) for name in ("skin", "tongue")]
            moves = self._basis.skin.moved(weights[0]), self._basis.tongue.moved(weights[1])
        levels = values.get("wrinkle_levels", np.zeros(0)).astype(np.float32)
        unfinished = (skin + moves[0]).astype(np.float32)
        head = matrix_of(values["head"])
        return values, self._unfinished.finished(unfinished, levels, head), (tongue + moves[1]).astype(np.float32)


def quaternions(rotations: npt.NDArray[np.floating[Any]]) -> Doubles:
    """``(N, 4)`` x y z w, w above 0, of rotations ``(N, 3, 3)`` by less than half a turn."""
    r = rotations.astype(np.float64)
    across = np.stack([r[:, 2, 1] - r[:, 1, 2], r[:, 0, 2] - r[:, 2, 0], r[:, 1, 0] - r[:, 0, 1]], axis=1)
    w = 0.5 * np.sqrt(np.maximum(1.0 + r[:, 0, 0] + r[:, 1, 1] + r[:, 2, 2], 1e-12))
    found = np.concatenate([across / (4.0 * w[:, None]), w[:, None]], axis=1)
    unit: Doubles = found / np.linalg.norm(found, axis=1, keepdims=True)
    return unit


def matrix_of(placed: npt.ArrayLike) -> npt.NDArray[np.float32]:
    """``(4, 4)`` float32 of seven numbers: a quaternion x y z w, and a way in m."""
    numbers = np.asarray(placed, np.float64)
    x, y, z, w = numbers[:4] / np.linalg.norm(numbers[:4])
    matrix = np.eye(4, dtype=np.float32)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, 3] = numbers[4:]
    return matrix
