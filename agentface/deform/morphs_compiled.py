"""The morphs' loop, single precision; the numpy twin is :mod:`agentface.deform.morphs`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform import morphs
from agentface.deform.lanes import LANES
from agentface.deform.morphs import LIP_HALVES, MorphTables
from agentface.deform.mouth.jaw_compiled import turns
from agentface.deform.simd_rows import put_columns, put_row, put_wide_row, row_at, wide_row_at, xs_of, ys_of, zs_of
from agentface.kernel import kernel

jaw_slide = kernel(error_model="numpy")(morphs.jaw_slide)
_share_of_lip = kernel(error_model="numpy")(morphs.share_of_lip)
_ZERO, _ONE = np.float32(0.0), np.float32(1.0)


@kernel(error_model="numpy")
def apply(tables: MorphTables, values: Floats, points: Floats) -> None:
    """Move ``points (P, 3)`` m in place, to the parameters ``values``."""
    used = np.zeros(LIP_HALVES + 1, np.float32)  # the last is of what belongs to no lip
    left = max(_ZERO, _ONE - values[tables.whole[0]] - values[tables.whole[1]])
    for morph in range(tables.parameters.shape[0]):
        used[tables.lips[morph]] += max(_ZERO, tables.signs[morph] * values[tables.parameters[morph]])
    if not used.any():
        return
    angle = np.float32(tables.widest * values[tables.jaw])
    ways = np.zeros((tables.shares.shape[0], 4), np.float32)
    for morph in range(tables.parameters.shape[0]):
        level = tables.signs[morph] * values[tables.parameters[morph]]
        if level <= _ZERO:
            continue
        if tables.lips[morph] >= 0:
            level *= _share_of_lip(left, used[tables.lips[morph]])
        for entry in range(tables.first[morph], tables.first[morph + 1]):
            at = 4 * tables.places[entry]
            put_wide_row(ways, at, wide_row_at(ways, at) + row_at(tables.ways, 3 * entry) * level)
    _move(tables, angle, ways, points)


@kernel(error_model="numpy")
def _move(tables: MorphTables, angle: np.float32, ways: Floats, points: Floats) -> None:
    """Move ``points (P, 3)`` m by ``ways`` m, a wide row each of ``tables.shares``, turned with the jaw."""
    count = tables.moved.shape[0]
    for start in range(0, ways.shape[0], LANES):
        cosine, sine = turns(tables.shares, start, angle)
        x, up, ahead = xs_of(ways, 4 * start), ys_of(ways, 4 * start), zs_of(ways, 4 * start)
        put_columns(ways, 4 * start, x, cosine * up - sine * ahead, sine * up + cosine * ahead)
    for row in range(count):
        at = 3 * tables.moved[row]
        put_row(points, at, row_at(points, at) + wide_row_at(ways, 4 * row))
