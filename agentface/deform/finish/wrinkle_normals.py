"""The normals of the skin once its wrinkles have risen: they differ from those before only near a wrinkle."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.finish.smooth_normals import SmoothNormalTables
from agentface.deform.finish.wrinkles import WrinkleTables
from agentface.mesh.normals import vertex_normals


class WrinkleNormalTables(NamedTuple):
    """What of the skin can change when wrinkles rise.

    Attributes:
        triangles: ``(T, 3)`` int32, all of the skin.
        raised: ``(R,)`` int32, the vertices that a wrinkle can raise.
        near: ``(N,)`` int32, the vertices of their triangles: normals that can change.
        around: ``(A, 4)`` int32, the quads of those, in their order among all.
    """

    triangles: Indices
    raised: Indices
    near: Indices
    around: Indices


def prepare(smooth: SmoothNormalTables, wrinkles: WrinkleTables) -> WrinkleNormalTables:
    """The tables of a face."""
    raised = np.unique(wrinkles.vertices)
    near = np.unique(smooth.triangles[np.isin(smooth.triangles, raised).any(axis=1)])
    around = smooth.quads[np.isin(smooth.quads, near).any(axis=1)]
    return WrinkleNormalTables(smooth.triangles, raised, near, around)


def apply(tables: WrinkleNormalTables, heights: Floats, vertices: Floats, smooth: Floats, out: Floats) -> None:
    """Write to ``out (V, 3)`` the unit normals of ``vertices (V, 3)`` m raised by ``heights (V,)`` m.

    ``smooth (V, 3)`` are those before; where nothing has risen they are taken as they are.
    """
    out[:] = smooth
    if heights[tables.raised].any():
        out[tables.near] = vertex_normals(vertices, tables.triangles)[tables.near]
