"""The lips of a portrait: the skin round the mouth cut finely, on the lips' B-spline surface.

A fine vertex is an edge with both ends at itself, so the shaders of the refined skin draw it as they are.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats, Indices
from agentface.deform.mouth.lip_mesh import patch_mesh
from agentface.deform.mouth.lip_surface import COLUMNS, ROWS
from agentface.deform.tables import of
from agentface.head.model import HeadModel
from agentface.mesh.refine import Refined

_CONTROLS = COLUMNS * ROWS
_FADE = 2.5  # rings of the patch over which its edge goes over into the skin beyond
_STIFF = 0.05  # keeps control points that few vertices hold from wandering


class FineLips:
    """Fine vertices between those of the lips' patch, and how they follow them.

    The surface's movement D is fitted to that of the patch, so any deformer will do; a fine vertex lies at
    D(u, v) plus the rounded rest of the mesh: x = sum of share (p - D) + D(u, v).

    Args:
        model: the face.
        per_cell: into how many parts a side of the patch's cells is cut, an even number, so that the middles of the
            outermost edges meet those of the refined skin beyond.
    """

    def __init__(self, model: HeadModel, per_cell: int = 4) -> None:
        tables = of(model).skin.lips
        fine = patch_mesh(tables, 2 * max(1, round(per_cell / 2)))
        self._first = len(model.vertices)
        self._patch, self._rings, self._fine = tables.patch, len(tables.along), fine
        of_patch = np.zeros((len(tables.patch), _CONTROLS))
        np.add.at(of_patch, (np.arange(len(of_patch))[:, None], tables.controls), tables.weight)
        fit = np.linalg.solve(of_patch.T @ of_patch + _STIFF * np.eye(_CONTROLS), of_patch.T)
        self._fit, self._of_patch = fit.astype(np.float32), (tables.controls, tables.weight)
        self._rest = tables.rest
        self._rest_fine = _mixed(tables.rest, fine.patch, fine.share)
        self._ends = self._edge_ends()
        inward = np.minimum(np.arange(fine.rings), np.arange(fine.rings)[::-1]) / (fine.rings / (len(tables.along) - 1))
        self._own = np.repeat(np.clip(inward / _FADE, 0, 1), fine.columns).astype(np.float32)[:, None]

    @property
    def count(self) -> int:
        """How many vertices it adds."""
        return len(self._rest_fine)

    def has_edges(self, edges: Indices) -> npt.NDArray[np.bool_]:
        """Which of ``edges (E, 2)`` lie within the patch: the ``skin`` of :meth:`mesh` must have cut them."""
        return np.asarray(np.isin(edges, self._patch).all(axis=1))

    def mesh(self, skin: Refined) -> Refined:
        """The refined ``skin`` with the lips' cells replaced by the fine ones, watertight along their edge."""
        within = np.asarray(np.isin(skin.ends, self._patch).all(axis=1))
        kept = skin.triangles[~within[skin.triangles].all(axis=1)]
        known = {(int(a), int(b)): number for number, (a, b) in enumerate(np.sort(skin.ends, axis=1))}
        numbers = len(skin.ends) + np.arange(self.count)
        for vertex, (a, b) in self._ends.items():
            numbers[vertex] = known[(min(a, b), max(a, b))]
        own = self._first + np.arange(self.count)
        ends = np.concatenate([skin.ends, np.repeat(own[:, None], 2, axis=1)]).astype(np.int32)
        triangles = numbers[self._fine.triangles]
        proper = (triangles[:, 0] != triangles[:, 1]) & (triangles[:, 1] != triangles[:, 2])
        triangles = triangles[proper & (triangles[:, 2] != triangles[:, 0])]
        return Refined(np.concatenate([kept, triangles]).astype(np.int32), ends)

    def extended(self, field: Floats) -> Floats:
        """A field ``(V, k)`` of the skin's vertices with its values at the fine vertices behind them."""
        there = np.clip(
            _mixed(field[self._patch], self._fine.patch, self._fine.share),
            field[self._patch].min(0),
            field[self._patch].max(0),
        )
        return np.concatenate([field, there]).astype(field.dtype)

    def update(self, vertices: Floats, normals: Floats) -> tuple[Floats, Floats]:
        """Places ``(count, 3)`` m and unit normals of the fine vertices in a frame of the skin's own ``(V, 3)``."""
        fine, moved = self._fine, vertices[self._patch] - self._rest
        control = self._fit @ moved
        there = _mixed(control, *self._of_patch)
        around = np.concatenate([moved, there, normals[self._patch]], axis=1)
        still, there, smooth = np.split(_mixed(around, fine.patch, fine.share), 3, axis=1)
        surface = _mixed(control, fine.controls, fine.weight) - there
        places = self._rest_fine + still + self._own * surface
        grid = places.reshape(self._fine.rings, self._fine.columns, 3)
        own = np.cross(np.gradient(grid, axis=0), np.roll(grid, -1, axis=1) - np.roll(grid, 1, axis=1)).reshape(-1, 3)
        own /= np.maximum(np.linalg.norm(own, axis=1, keepdims=True), 1e-12)
        mixed = self._own * own + (1 - self._own) * smooth
        mixed /= np.maximum(np.linalg.norm(mixed, axis=1, keepdims=True), 1e-12)
        return np.asarray(places, np.float32), np.asarray(mixed, np.float32)

    def record(self) -> dict[str, Any]:
        """What :meth:`update` is made of."""
        fine, (controls, weight) = self._fine, self._of_patch
        return {
            "patch": self._patch,
            "fit": self._fit,
            "patch_controls": controls,
            "patch_weight": weight,
            "rings": fine.rings,
            "columns": fine.columns,
            "share_of": fine.patch,
            "share": fine.share,
            "controls": fine.controls,
            "weight": fine.weight,
            "rest": self._rest_fine,
            "own": self._own[:, 0],
        }

    def _edge_ends(self) -> dict[int, tuple[int, int]]:
        """For fine vertices on the patch's edge the two ends of the skin's edge whose middle, or end, they are."""
        rings, columns = self._fine.rings, self._fine.columns
        coarse = self._patch.reshape(self._rings, -1)
        cells = columns // coarse.shape[1]
        ends = {}
        for ring, edge in ((0, coarse[0]), (rings - 1, coarse[-1])):
            for column in range(columns):
                here, part = divmod(column, cells)
                a, b = int(edge[here]), int(edge[(here + 1) % len(edge)])
                ends[ring * columns + column] = (a, a) if 2 * part < cells else (a, b)
        return ends


def _mixed(points: Floats, index: Indices, weight: Floats) -> Floats:
    """``(N, k)``: sums of rows of ``points`` at ``index (N, 16)`` by ``weight``."""
    return np.asarray(np.einsum("nj,njk->nk", weight, points[index]), np.float32)
