"""The normals of the skin once its wrinkles have risen: they differ from those before only near a wrinkle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.finish.wrinkles import WrinkleTables
from agentface.head.model import HeadModel
from agentface.mesh.normals import vertex_normals


class WrinkleNormalTables(NamedTuple):
    """What of the skin can change when wrinkles rise.

    Attributes:
        triangles: ``(T, 3)`` int32, all of the skin.
        raised: ``(R,)`` int32, the vertices that a wrinkle can raise.
        near: ``(N,)`` int32, the vertices of their triangles: normals that can change.
        around: ``(A, 3)`` int32, the triangles of those, in their order among all.
        border: ``(B,)`` int32, the other vertices of these.
    """

    triangles: Indices
    raised: Indices
    near: Indices
    around: Indices
    border: Indices


def prepare(model: HeadModel, wrinkles: WrinkleTables) -> WrinkleNormalTables:
    """The tables of a face."""
    triangles = np.ascontiguousarray(model.triangles, np.int32)
    raised = np.unique(wrinkles.vertices)
    near = np.unique(triangles[np.isin(triangles, raised).any(axis=1)])
    around = triangles[np.isin(triangles, near).any(axis=1)]
    return WrinkleNormalTables(triangles, raised, near, around, np.setdiff1d(around, near))


def apply(tables: WrinkleNormalTables, heights: Floats, vertices: Floats, smooth: Floats, out: Floats) -> None:
    """Write to ``out (V, 3)`` the unit normals of ``vertices (V, 3)`` m raised by ``heights (V,)`` m.

    ``smooth (V, 3)`` are those before; where nothing has risen they are taken as they are.
    """
    out[:] = smooth
    if heights[tables.raised].any():
        out[tables.near] = vertex_normals(vertices, tables.triangles)[tables.near]
