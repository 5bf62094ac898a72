"""What of a face moves by itself, as one row of numbers: skin, lower teeth, tongue, and hairs that turn on the skin."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from agentface.conventions import Doubles
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.io.gltf.face_parts import FacePart, PlacesAndNormals
from agentface.io.gltf.writer import Target, moved_between
from agentface.mesh.normals import vertex_normals

SOFT = ("skin", "teeth_lower", "tongue", "brows", "lashes")
_STILL_M = 1e-6


class Surface:
    """Rows ``(3 N,)`` m of the movement of N vertices from rest, and what they are to every part.

    Args:
        model: the face.
        parts: its parts, those of ``SOFT`` among them; of brows and lashes a look may have none.
    """

    def __init__(self, model: HeadModel, parts: Sequence[FacePart]) -> None:
        self._parts, self._triangles = parts, model.triangles
        named = {part.name: part for part in parts}
        self._soft = [named[name] for name in SOFT if name in named]
        self._at_rest = FaceGeometry.at_rest(model)
        self._rest = {part.name: part.at(self._at_rest) for part in parts}
        places = [self._rest[part.name][0] for part in self._soft]
        self._ends = np.cumsum([len(rows) for rows in places])
        self._flat = np.concatenate(places).astype(np.float64).ravel()

    @property
    def size(self) -> int:
        """The length of a row."""
        return len(self._flat)

    def row(self, geometry: FaceGeometry) -> Doubles:
        """The movement ``(3 N,)`` m of a released geometry (:func:`agentface.io.gltf.face_parts.released`)."""
        places = [part.at(geometry)[0] for part in self._soft]
        return np.concatenate(places).astype(np.float64).ravel() - self._flat

    def targets(self, geometry: FaceGeometry) -> dict[str, Target]:
        """By part, how a released geometry differs from rest; parts that do not move are left out."""
        return _moving({part.name: self._target(part, part.at(geometry)) for part in self._parts})

    def targets_of(self, row: Doubles) -> dict[str, Target]:
        """By part, what a movement ``(3 N,)`` m of what is in a row makes of all."""
        split = np.split((self._flat + row).reshape(-1, 3).astype(np.float32), self._ends[:-1])
        shown = {part.name: places for part, places in zip(self._soft, split, strict=True)}
        geometry = self._at_rest.copy()
        geometry.vertices = shown["skin"]
        geometry.normals = geometry.smooth_normals = vertex_normals(shown["skin"], self._triangles).astype(np.float32)
        found = {}
        for part in self._parts:
            there = part.at(geometry)
            if part.name in shown and part.name != SOFT[0]:
                places = shown[part.name]
                there = places, vertex_normals(places, part.triangles).astype(np.float32)
            found[part.name] = self._target(part, there)
        return _moving(found)

    def _target(self, part: FacePart, there: PlacesAndNormals) -> Target:
        target = moved_between(self._rest[part.name], there)
        return target if part.turning else Target(target.places)


def apart_mm(rows: Doubles) -> Doubles:
    """``(..., N)`` mm: how far each vertex goes in rows ``(..., 3 N)`` m."""
    return np.asarray(1e3 * np.linalg.norm(rows.reshape(*rows.shape[:-1], -1, 3), axis=-1))


def less(first: Target, second: Target) -> Target:
    """``first`` without ``second``."""
    if first.normals is None or second.normals is None:
        return Target(first.places - second.places)
    return Target(first.places - second.places, first.normals - second.normals)


def _moving(found: dict[str, Target]) -> dict[str, Target]:
    return {name: target for name, target in found.items() if np.abs(target.places).max(initial=0.0) > _STILL_M}
