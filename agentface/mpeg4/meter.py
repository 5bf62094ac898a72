"""What a face shows, in the terms of MPEG-4: a geometry to FAPs (ISO/IEC 14496-2, Table C-1)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform.geometry import FaceArrays, FaceGeometry
from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.kernel import can_compile
from agentface.mpeg4.faps import FAP_COUNT, LOW_LEVEL, Fap
from agentface.mpeg4.fapu import fapu
from agentface.mpeg4.feature_points import feature_points
from agentface.mpeg4.readings import Kind, Readings, read

_AXIS = {"left": 0, "right": 0, "up": 1, "down": 1, "forward": 2}
_SIGN = {"left": 1.0, "up": 1.0, "forward": 1.0, "right": -1.0, "down": -1.0}
JAW = (3, 14, 15)
"""Read off the jaw's bone: on the skin of the chin, muscles would open the jaw, and the jaw thrust itself."""
CHIN = 18
"""Read in the jaw's frame: elsewhere, every opened jaw would draw the chin down."""
EYES = (23, 24, 25, 26)
HEAD = (48, 49, 50)


class FapMeter:
    """Measures the low-level FAPs of one face's geometries, whatever deformer made them.

    Decisions, where the standard has a face of points and not of flesh: skin is read below its wrinkles; the jaw's
    FAPs 3, 14 and 15 are those of the bone, 3 the descent of 2.1 carried by it, 14 and 15 the way of its hinge; FAP 18
    is the chin's way in the jaw's frame; eyes and head are read off their rotations.

    Args:
        model: the face.
        compiled: False for the numpy form.

    Raises InvalidValueError where the face lacks a feature point that a FAP moves.
    """

    def __init__(self, model: HeadModel, *, compiled: bool = True) -> None:
        self.model, self.units, self.points = model, fapu(model), feature_points(model)
        self.faps = tuple(fap for fap in LOW_LEVEL if fap.number in JAW or _reads_skin(model, fap))
        """Those that are read off points, in the order of their numbers."""
        self.columns = np.array([fap.number - 1 for fap in self.faps])
        self.readings = _readings(model, self.faps)
        self._read: Callable[..., None] = _read_faces
        if compiled and can_compile():
            from agentface.mpeg4 import meter_compiled

            self._read = meter_compiled.read_faces

    def measure(self, geometry: FaceGeometry) -> Floats:
        """``(..., 68)`` float32, FAP n at n - 1, for a geometry of any leading dimensions; 1 and 2 are 0.

        Raises InvalidValueError for a geometry of another mesh.
        """
        if geometry.vertices.shape[-2:] != self.model.vertices.shape:
            expected = f"the {len(self.model.vertices)} vertices of {self.model.name}"
            raise InvalidValueError("geometry", expected, geometry.vertices.shape)
        batch = geometry.batch
        count = int(np.prod(batch, dtype=np.int64))
        faces = FaceArrays(*(_flat(array, len(batch), count) for array in geometry.arrays()))
        points = np.empty((count, len(self.faps)))
        self._read(self.readings, faces, points)
        faps = np.zeros((count, FAP_COUNT), np.float32)
        faps[:, self.columns] = points
        faps[:, np.array(EYES) - 1] = _eyes(faces.eye_rotations) / self.units.AU
        faps[:, np.array(HEAD) - 1] = _head(faces.head) / self.units.AU
        return faps.reshape(*batch, FAP_COUNT)


def _flat(array: Floats, leading: int, count: int) -> Floats:
    return array.reshape(count, *array.shape[leading:])


def _reads_skin(model: HeadModel, fap: Fap) -> bool:
    row = model.feature_points[fap.points[0]]
    if row.absent is not None and fap.positive in _AXIS:
        raise InvalidValueError(f"feature point {fap.points[0]}", f"a point that {model.name} has", "none", row.absent)
    return row.vertex is not None and row.mesh == "skin"


def _readings(model: HeadModel, faps: tuple[Fap, ...]) -> Readings:
    units, points = fapu(model), feature_points(model)
    bone = np.array([points["2.1"].position, model.jaw.pivot], np.float64)
    rows: list[tuple[int, int, int, float, float]] = []
    for fap in faps:
        axis, scale = _AXIS[fap.positive], _SIGN[fap.positive] / units.of(fap.unit)
        if fap.number in JAW:
            which = JAW.index(fap.number) > 0
            rows.append((Kind.BONE, int(which), axis, scale, bone[int(which), axis]))
        else:
            point = points[fap.points[0]]
            kind = Kind.IN_JAW if fap.number == CHIN else Kind.SKIN
            rows.append((kind, point.vertex, axis, scale, float(point.position[axis])))
    kinds, vertices, axes, scales, rests = zip(*rows, strict=True)
    of_kind, vertex, axis_of = (np.array(column, np.int32) for column in (kinds, vertices, axes))
    return Readings(of_kind, vertex, axis_of, np.array(scales, np.float64), np.array(rests, np.float64), bone)


def _read_faces(readings: Readings, faces: FaceArrays, out: Doubles) -> None:
    """Write the numbers of ``B`` faces into ``out (B, N)``."""
    for index in range(len(out)):
        read(readings, FaceArrays(*(array[index] for array in faces)), out[index])


def _eyes(rotations: Floats) -> Doubles:
    """``(B, 4)`` rad: yaw of the left and the right eye to the left, then pitch of both downward."""
    turns: np.ndarray[Any, np.dtype[np.float64]] = rotations.astype(np.float64)
    yaw = np.arctan2(turns[..., 0, 2], turns[..., 0, 0])
    pitch = np.arctan2(turns[..., 2, 1], turns[..., 1, 1])
    return np.concatenate([yaw, pitch], axis=-1)


def _head(transforms: Floats) -> Doubles:
    """``(B, 3)`` rad: pitch downward, yaw to the left, roll to the right, of R = Y(yaw) X(pitch) Z(roll)."""
    turn = transforms[..., :3, :3].astype(np.float64)
    pitch = -np.arcsin(np.clip(turn[..., 1, 2], -1.0, 1.0))
    yaw = np.arctan2(turn[..., 0, 2], turn[..., 2, 2])
    roll = np.arctan2(turn[..., 1, 0], turn[..., 1, 1])
    return np.stack([pitch, yaw, roll], axis=-1)
