"""The normals of the skin before its wrinkles rise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.head.model import HeadModel
from agentface.mesh.normals import vertex_normals


class SmoothNormalTables(NamedTuple):
    """The skin in two forms.

    Attributes:
        triangles: ``(T, 3)`` int32.
        quads: ``(Q, 4)`` int32, the same as :func:`quads_of` has it: two of four corners share what they need.
    """

    triangles: Indices
    quads: Indices


def prepare(model: HeadModel) -> SmoothNormalTables:
    """The tables of a face."""
    triangles = np.ascontiguousarray(model.triangles, np.int32)
    return SmoothNormalTables(triangles, quads_of(triangles))


def quads_of(triangles: Indices) -> Indices:
    """``(Q, 4)`` corners a, b, c, d of the triangles a b c and a c d, in the order of the first of each two.

    A triangle that no other is left for stands alone, with d = a.
    """
    count = len(triangles)
    beside = _beside(triangles)
    partner = np.full(count, -1)
    while True:
        free = (beside >= 0) & (partner[beside] < 0) & (partner < 0)[:, None]
        wanted = np.where(free, beside, count).min(axis=1)
        chosen = np.flatnonzero(wanted < count)
        chosen = chosen[wanted[wanted[chosen]] == chosen]  # the first triangle of all that want one is always among
        if len(chosen) == 0:
            break
        partner[chosen] = wanted[chosen]
    one = np.flatnonzero((partner < 0) | (partner > np.arange(count)))
    other = partner[one]
    # the shared edge is the one from c to a
    edge = np.where(other >= 0, (beside[one] == other[:, None]).argmax(axis=1), 2)
    c, a, b = (triangles[one, (edge + i) % 3] for i in range(3))
    theirs = triangles[other]
    d = theirs[np.arange(len(one)), ((theirs != a[:, None]) & (theirs != c[:, None])).argmax(axis=1)]
    return np.ascontiguousarray(np.column_stack([a, b, c, np.where(other >= 0, d, a)]), np.int32)


def _beside(triangles: Indices) -> Indices:
    """``(T, 3)``: the triangle across the edge from each corner to the next one, or -1."""
    start, end = triangles.astype(np.int64), np.roll(triangles, -1, axis=1).astype(np.int64)
    size = triangles.max(initial=0) + 1
    own, across = (start * size + end).ravel(), (end * size + start).ravel()
    order = np.argsort(own)
    place = order[np.minimum(np.searchsorted(own[order], across), len(own) - 1)]
    return np.where(own[place] == across, place // 3, -1).reshape(-1, 3)


def apply(tables: SmoothNormalTables, vertices: Floats, out: Floats) -> None:
    """Write the unit normals of ``vertices (V, 3)`` m into ``out (V, 3)``."""
    out[:] = vertex_normals(vertices, tables.triangles)
