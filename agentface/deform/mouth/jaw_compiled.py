"""The jaw's turn, single precision; the numpy twin is :mod:`agentface.deform.mouth.jaw`."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats
from agentface.deform.lanes import LANES
from agentface.deform.mouth.jaw import JawTables
from agentface.deform.simd import load, splat
from agentface.deform.simd_rows import put_columns, put_row, put_wide_row, row_at, wide_row_at, xs_of, ys_of, zs_of
from agentface.kernel import kernel

_ONE = np.float32(1.0)
# of the Taylor series of the cosine and the sine in nested form: exact in single precision up to 60 degrees
_COSINE = tuple(np.float32(-1.0 / (n * (n - 1))) for n in (2, 4, 6, 8, 10))
_SINE = tuple(np.float32(-1.0 / (n * (n - 1))) for n in (3, 5, 7, 9, 11))


@kernel(error_model="numpy")
def apply(tables: JawTables, values: Floats, points: Floats) -> None:
    """Turn ``points (P, 3)`` m in place, to the pose ``values``; a closed jaw leaves them as they are."""
    angle = np.float32(tables.widest * values[tables.parameter])
    if angle == 0.0:
        return
    hinge_y, hinge_z, opening = tables.hinge[0], tables.hinge[1], values[tables.parameter]
    rows, count = np.empty((LANES, 4), np.float32), tables.where.shape[0]
    for start in range(0, count, LANES):
        full = min(LANES, count - start)
        for lane in range(full):
            put_wide_row(rows, 4 * lane, row_at(points, 3 * tables.where[start + lane]))
        cosine, sine = turns(tables.share, start, angle)
        x = xs_of(rows, 0) + load(tables.drawn, 2 * start) * opening
        up = ys_of(rows, 0) - hinge_y
        forward = zs_of(rows, 0) + load(tables.drawn, 2 * start + LANES) * opening - hinge_z
        put_columns(rows, 0, x, cosine * up - sine * forward + hinge_y, sine * up + cosine * forward + hinge_z)
        for lane in range(full):
            put_row(points, 3 * tables.where[start + lane], wide_row_at(rows, 4 * lane))


@kernel(error_model="numpy")
def turns(share: Floats, start: int, angle: np.float32) -> Any:
    """The cosines and sines of the turns of one block of ``share``, vectors; ``angle`` is the whole turn, rad."""
    c2, c4, c6, c8, c10 = _COSINE
    s3, s5, s7, s9, s11 = _SINE
    one = splat(_ONE)
    turn = load(share, start) * angle
    square = turn * turn
    cosine = one + square * c8 * (one + square * c10)
    cosine = one + square * c2 * (one + square * c4 * (one + square * c6 * cosine))
    sine = one + square * s9 * (one + square * s11)
    sine = turn * (one + square * s3 * (one + square * s5 * (one + square * s7 * sine)))
    return cosine, sine
