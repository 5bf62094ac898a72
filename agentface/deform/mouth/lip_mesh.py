"""The lips as fine as one likes: the mesh at rest rounded off, moved by the B-spline surface itself."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.mouth.lip_surface import COLUMNS, moved_with, weights
from agentface.deform.mouth.lips import LipTables
from agentface.errors import InvalidValueError

_FINEST = 64


class LipMesh(NamedTuple):
    """A finer grid over the patch of :class:`agentface.deform.mouth.lips.LipTables`.

    Attributes:
        rings, columns: F vertices = rings x columns, closed along the columns; the first ring is inside the mouth.
        patch, share: ``(F, 16)``: rows of the patch round each vertex, and their weights.
        controls, weight: ``(F, 16)``: control points of the surface there, and their weights.
        free: ``(F,)`` 1, and 0 on both outermost rings, which keep to the straight edges of the mesh beyond.
        triangles: ``(T, 3)``, counter-clockwise seen from outside.
    """

    rings: int
    columns: int
    patch: Indices
    share: Floats
    controls: Indices
    weight: Floats
    free: Floats
    triangles: Indices


def patch_mesh(tables: LipTables, per_cell: int) -> LipMesh:
    """Each cell of the patch cut into ``per_cell`` x ``per_cell``; raises InvalidValueError unless that is in 1..64."""
    if not 1 <= per_cell <= _FINEST:
        raise InvalidValueError("per_cell", f"a whole number in 1..{_FINEST}", per_cell)
    rings, columns = len(tables.along), len(tables.across)
    at_ring = np.arange((rings - 1) * per_cell + 1) / per_cell
    at_column = np.arange(columns * per_cell) / per_cell
    ring, of_ring = _open(at_ring, rings)
    column, of_column = _closed(at_column, columns)
    edge = np.isin(at_ring, (0, rings - 1))
    of_column = np.where(edge[:, None, None], _straight(at_column), of_column)
    share = of_ring[:, None, :, None] * of_column[:, :, None, :]
    patch = ring[:, None, :, None] * columns + column[None, :, None, :]
    shape = (len(at_ring), len(at_column))
    along = (of_ring * tables.along[ring].astype(np.float64)).sum(1)
    across, at_along = _across(tables, at_column) + np.zeros(shape), along.clip(0, 1)[:, None] + np.zeros(shape)
    controls, weight = weights(moved_with(across, at_along), at_along)
    return LipMesh(
        *shape,
        patch=np.broadcast_to(patch, share.shape).reshape(-1, 16).astype(np.int32),
        share=share.reshape(-1, 16).astype(np.float32),
        controls=controls.reshape(-1, 16),
        weight=weight.reshape(-1, 16).astype(np.float32),
        free=np.repeat(~edge, shape[1]).astype(np.float32),
        triangles=_triangles(*shape),
    )


def evaluate(tables: LipTables, fine: LipMesh, points: Floats) -> tuple[Floats, Floats]:
    """Positions ``(F, 3)`` m and unit normals of the fine lips in the frame ``points (V + 144, 3)``, when it is done.

    x = sum of share (p - D) + D(u, v), with p the vertices of the patch, D the movement of the surface there and at
    the fine vertex: vertices of the patch stay where they are, and between them the surface tells the way.
    """
    moved = points[tables.skin_count :] - tables.control_rest
    at_patch = (tables.weight[..., None] * moved[tables.controls]).sum(1)
    at_fine = (fine.weight[..., None] * moved[fine.controls]).sum(1)
    vertices = points[tables.patch]
    free = fine.free[:, None]
    still = (fine.share[..., None] * (vertices - at_patch)[fine.patch]).sum(1)
    straight = (fine.share[..., None] * vertices[fine.patch]).sum(1)
    places = free * (still + at_fine) + (1 - free) * straight
    grid = places.reshape(fine.rings, fine.columns, 3)
    over = np.roll(grid, -1, axis=1) - np.roll(grid, 1, axis=1)
    out = np.gradient(grid, axis=0)
    normals = np.cross(out, over).reshape(-1, 3)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    return np.asarray(places, np.float32), np.asarray(normals / np.maximum(length, 1e-12), np.float32)


def _across(tables: LipTables, at_column: Doubles) -> Doubles:
    """Where the fine columns lie on the surface: smoothly between the columns of the patch."""
    known = np.unwrap(tables.across.astype(np.float64), period=COLUMNS)
    column, weight = _closed(at_column, len(known))
    turns = np.floor(at_column).astype(np.int64)[:, None] + np.arange(-1, 3)
    return np.asarray((weight * (known[column] + COLUMNS * np.floor_divide(turns, len(known)))).sum(1) % COLUMNS)


def _closed(at: Doubles, count: int) -> tuple[Indices, Doubles]:
    index = (np.floor(at).astype(np.int64)[:, None] + np.arange(-1, 3)) % count
    return index.astype(np.int32), _catmull_rom(at - np.floor(at))


def _open(at: Doubles, count: int) -> tuple[Indices, Doubles]:
    """As :func:`_closed` between two ends, beyond which the line goes straight on."""
    cell = np.minimum(np.floor(at), count - 2)
    weight = _catmull_rom(at - cell)
    index = cell.astype(np.int64)[:, None] + np.arange(-1, 3)
    for outside, end, inner in ((0, 1, 2), (3, 2, 1)):
        beyond = (index[:, outside] < 0) | (index[:, outside] >= count)
        spare = np.where(beyond, weight[:, outside], 0.0)
        weight[:, end] += 2 * spare
        weight[:, inner] -= spare
        weight[:, outside] -= spare
    return np.clip(index, 0, count - 1).astype(np.int32), weight


def _catmull_rom(t: Doubles) -> Doubles:
    """``(K, 4)`` weights of the cubic through the middle two of four points (Catmull and Rom 1974)."""
    rows = [-t + 2 * t**2 - t**3, 2 - 5 * t**2 + 3 * t**3, t + 4 * t**2 - 3 * t**3, t**3 - t**2]
    return np.stack(rows, axis=1) / 2


def _straight(at: Doubles) -> Doubles:
    t = at - np.floor(at)
    return np.stack([0 * t, 1 - t, t, 0 * t], axis=1)


def _triangles(rings: int, columns: int) -> Indices:
    ring, column = np.meshgrid(np.arange(rings - 1), np.arange(columns), indexing="ij")
    here, aside = ring * columns + column, ring * columns + (column + 1) % columns
    faces = [[here, here + columns, aside], [aside, here + columns, aside + columns]]
    return np.concatenate([np.stack(face, axis=-1).reshape(-1, 3) for face in faces]).astype(np.int32)
