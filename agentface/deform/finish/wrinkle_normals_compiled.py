"""Normals once wrinkles have risen, single precision; the numpy twin is :mod:`.wrinkle_normals`."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats
from agentface.deform.finish.wrinkle_normals import WrinkleNormalTables
from agentface.kernel import kernel
from agentface.mesh.normals_compiled import add_areas, make_unit

_ZERO = np.float32(0.0)


@kernel(error_model="numpy", fastmath=True)
def apply(tables: WrinkleNormalTables, heights: Floats, vertices: Floats, smooth: Floats, out: Floats) -> None:
    """Write to ``out (V, 3)`` the unit normals of ``vertices (V, 3)``, raised by ``heights (V,)``."""
    before, after = smooth.ravel(), out.ravel()
    for index in range(before.shape[0]):
        after[index] = before[index]
    if _highest(tables, heights) > _ZERO:
        _renew(tables, vertices, smooth, out)


@kernel(error_model="numpy", fastmath=True)
def _renew(tables: WrinkleNormalTables, vertices: Floats, smooth: Floats, out: Floats) -> None:
    for place in range(tables.near.shape[0]):
        for axis in range(3):
            out[tables.near[place], axis] = _ZERO
    add_areas(vertices, tables.around, out)
    for place in range(tables.near.shape[0]):
        make_unit(out, tables.near[place])
    for place in range(tables.border.shape[0]):
        vertex = tables.border[place]
        for axis in range(3):
            out[vertex, axis] = smooth[vertex, axis]


@kernel(error_model="numpy")
def _highest(tables: WrinkleNormalTables, heights: Floats) -> Any:
    highest = _ZERO
    for place in range(tables.raised.shape[0]):
        highest = max(highest, heights[tables.raised[place]])
    return highest
