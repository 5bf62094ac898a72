"""Normals once wrinkles have risen, single precision; the numpy twin is :mod:`.wrinkle_normals`."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats
from agentface.deform.finish.smooth_normals_compiled import add_areas, put_unit
from agentface.deform.finish.wrinkle_normals import WrinkleNormalTables
from agentface.deform.simd_rows import put_wide_row, row_of
from agentface.kernel import kernel

_ZERO = np.float32(0.0)


@kernel(error_model="numpy", fastmath=True)
def apply(tables: WrinkleNormalTables, heights: Floats, vertices: Floats, smooth: Floats, out: Floats) -> None:
    """Write to ``out (V, 3)`` the unit normals of ``vertices (V, 3)``, raised by ``heights (V,)``."""
    before, after = smooth.ravel(), out.ravel()
    for index in range(before.shape[0]):
        after[index] = before[index]
    if _highest(tables, heights) > _ZERO:
        _renew(tables, vertices, out)


@kernel(error_model="numpy", fastmath=True)
def _renew(tables: WrinkleNormalTables, vertices: Floats, out: Floats) -> None:
    sums = np.empty((vertices.shape[0], 4), np.float32)  # what is not near is added to and never read
    for place in range(tables.near.shape[0]):
        put_wide_row(sums, 4 * tables.near[place], row_of(_ZERO))
    add_areas(vertices, tables.around, sums)
    for place in range(tables.near.shape[0]):
        put_unit(sums, tables.near[place], out)


@kernel(error_model="numpy")
def _highest(tables: WrinkleNormalTables, heights: Floats) -> Any:
    highest = _ZERO
    for place in range(tables.raised.shape[0]):
        highest = max(highest, heights[tables.raised[place]])
    return highest
