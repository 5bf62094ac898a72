"""The jaw's turn, single precision; the numpy twin is :mod:`agentface.deform.mouth.jaw`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.lanes import LANES
from agentface.deform.mouth.jaw import JawTables
from agentface.deform.simd import load, splat, store
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
    y, z, opening = tables.hinge[0], tables.hinge[1], values[tables.parameter]
    cosines, sines = np.empty(LANES, np.float32), np.empty(LANES, np.float32)
    count = tables.where.shape[0]
    for start in range(0, count, LANES):
        _turn(tables.share, start, angle, cosines, sines)
        for lane in range(min(LANES, count - start)):
            entry = start + lane
            point, cosine, sine = tables.where[entry], cosines[lane], sines[lane]
            points[point, 0] += opening * tables.drawn[entry, 0]
            up, forward = points[point, 1] - y, points[point, 2] + opening * tables.drawn[entry, 1] - z
            points[point, 1] = y + cosine * up - sine * forward
            points[point, 2] = z + sine * up + cosine * forward


@kernel(error_model="numpy")
def _turn(share: Floats, start: int, angle: np.float32, cosines: Floats, sines: Floats) -> None:
    """The cosines and sines of the turns of one block of ``share``, angles in radians."""
    c2, c4, c6, c8, c10 = _COSINE
    s3, s5, s7, s9, s11 = _SINE
    one = splat(_ONE)
    turn = load(share, start) * angle
    square = turn * turn
    cosine = one + square * c8 * (one + square * c10)
    cosine = one + square * c2 * (one + square * c4 * (one + square * c6 * cosine))
    sine = one + square * s9 * (one + square * s11)
    sine = turn * (one + square * s3 * (one + square * s5 * (one + square * s7 * sine)))
    store(cosines, 0, cosine)
    store(sines, 0, sine)
