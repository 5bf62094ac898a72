"""The skin before what every deformer's skin gets last: wrinkles that rise, and a neck that stays behind the head.

A page does these stages itself, so that what travels need not hold them. A vertex of the neck whose share ``s`` stays
behind lies at (1 - s) p + s H^-1 p, with H the head's turn; A = (1 - s) I + s R^T is undone in closed form: it leaves
the turn's axis as it is and turns and shrinks what is across it.
"""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform import tables as deform_tables
from agentface.deform.finish import neck, wrinkles
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.mesh.normals import vertex_normals

_STRAIGHT = 1e-9  # radians; no turn


class Unfinished:
    """The skin of geometries of one face as it is before its last stages, and the way back."""

    def __init__(self, model: HeadModel) -> None:
        tables = deform_tables.of(model).finish
        self._neck, self._wrinkles, self._triangles = tables.neck, tables.wrinkles, tables.smooth_normals.triangles
        self._raised = tables.wrinkles.raised
        self._stays = tables.neck.stays.astype(np.float64)
        self._raised_neck = np.flatnonzero(np.isin(tables.neck.where, tables.wrinkles.raised))

    def skin(self, geometry: FaceGeometry) -> Floats:
        """``(..., V, 3)`` float32 m; of a batch only where no head is turned."""
        vertices = geometry.vertices.copy()
        raised = self._raised
        heights, normals = geometry.wrinkles[..., raised, None], geometry.smooth_normals[..., raised, :]
        axis, angle = turn_of(geometry.head[..., :3, :3]) if not geometry.batch else (np.zeros(3), 0.0)
        if angle > _STRAIGHT:
            normals = self._undo_neck(geometry, vertices, normals, axis, angle)
        vertices[..., raised, :] -= heights * normals
        return vertices

    def finished(self, skin: Floats, levels: Floats, head: Floats) -> Floats:
        """``(V, 3)`` float32 m: the ``vertices`` of the geometry that ``skin`` is of.

        Args:
            skin: ``(V, 3)`` m, as :meth:`skin` gives it.
            levels: ``(K,)`` 0..1, ``FaceGeometry.wrinkle_levels``.
            head: ``(4, 4)``, ``FaceGeometry.head``.
        """
        tables = self._wrinkles
        vertices, normals = skin.copy(), vertex_normals(skin, self._triangles).astype(np.float32)
        heights = np.zeros(len(skin), np.float32)
        np.maximum.at(heights, tables.vertices, np.repeat(levels, np.diff(tables.first)) * tables.heights)
        wrinkles.raise_vertices(tables, heights, normals, vertices)
        neck.apply(self._neck, head, vertices, normals.copy(), normals)
        return vertices

    def _undo_neck(
        self, geometry: FaceGeometry, vertices: Floats, normals: Floats, axis: Doubles, angle: float
    ) -> Floats:
        """Put the neck of ``vertices`` where it is while the head is straight; the unit normals there of what rises."""
        where, stays = self._neck.where, self._stays
        turn, offset = geometry.head[:3, :3].astype(np.float64), geometry.head[:3, 3].astype(np.float64)
        moved = vertices[where] + stays[:, None] * (offset @ turn)
        vertices[where] = _undone(moved, stays, axis, angle)
        if not len(self._raised_neck):
            return normals
        shared = self._raised_neck
        facing = _undone(geometry.smooth_normals[where[shared]].astype(np.float64), stays[shared], axis, angle)
        normals = normals.copy()
        places = np.searchsorted(self._raised, where[shared])
        normals[places] = facing / np.linalg.norm(facing, axis=1, keepdims=True)
        return normals


def turn_of(rotation: Floats) -> tuple[Doubles, float]:
    """The unit axis ``(3,)`` and the angle in radians, 0..pi, of a rotation ``(3, 3)``."""
    across = rotation.astype(np.float64)
    axis = np.array([across[2, 1] - across[1, 2], across[0, 2] - across[2, 0], across[1, 0] - across[0, 1]])
    length = float(np.linalg.norm(axis))
    angle = math.atan2(length, float(np.trace(across)) - 1.0)
    return (axis / length if length > 0.0 else axis), angle


def _undone(points: Doubles, stays: Doubles, axis: Doubles, angle: float) -> Doubles:
    """The p of A p = ``points (N, 3)``, where A = (1 - s) I + s R^T, R the turn by ``angle`` about ``axis``."""
    kept, turned = 1.0 - stays + stays * math.cos(angle), stays * math.sin(angle)
    size = kept * kept + turned * turned
    along = np.outer(points @ axis, axis)
    across = points - along
    undone: Doubles = along + (kept / size)[:, None] * across + (turned / size)[:, None] * np.cross(axis, across)
    return undone
