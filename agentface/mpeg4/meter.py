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
from agentface.mpeg4.fap_readings import EYES, HEAD, fap_readings
from agentface.mpeg4.faps import FAP_COUNT, LOW_LEVEL
from agentface.mpeg4.fapu import fapu
from agentface.mpeg4.feature_points import feature_points
from agentface.mpeg4.readings import Readings, read


class FapMeter:
    """Measures the low-level FAPs of one face's geometries, whatever deformer made them.

    Decisions, where the standard has a face of points and not of flesh: skin is read below its wrinkles; the jaw's
    FAPs 3, 14 and 15 are those of the bone, 3 the descent of 2.1 carried by it, 14 and 15 the way of its hinge; FAP 18
    is the chin's way in the jaw's frame, and so are those of the tongue (43 to 46); 47 is the angle from the tongue's
    middle up to its borders; a pupil at rest is a third of the iris; eyes and head are read off their rotations.

    Args:
        model: the face.
        compiled: False for the numpy form.

    Raises InvalidValueError where the face lacks a feature point that a FAP moves.
    """

    def __init__(self, model: HeadModel, *, compiled: bool = True) -> None:
        self.model, self.units, self.points = model, fapu(model), feature_points(model)
        self.faps = tuple(fap for fap in LOW_LEVEL if fap.number not in (*EYES, *HEAD))
        """Those that are read off points, in the order of their numbers."""
        self.columns = np.array([fap.number - 1 for fap in self.faps])
        self.readings = fap_readings(model, self.faps)
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
