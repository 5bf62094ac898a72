"""The jaw's turn, single precision; the numpy twin is :mod:`agentface.deform.mouth.jaw`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.mouth.jaw import JawTables
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
    y, z = tables.hinge[0], tables.hinge[1]
    c2, c4, c6, c8, c10 = _COSINE
    s3, s5, s7, s9, s11 = _SINE
    for entry in range(tables.where.shape[0]):
        point = tables.where[entry]
        turn = angle * tables.share[entry]
        square = turn * turn
        cosine = _ONE + c2 * square * (
            _ONE + c4 * square * (_ONE + c6 * square * (_ONE + c8 * square * (_ONE + c10 * square)))
        )
        sine = turn * (
            _ONE
            + s3 * square * (_ONE + s5 * square * (_ONE + s7 * square * (_ONE + s9 * square * (_ONE + s11 * square))))
        )
        points[point, 0] += values[tables.parameter] * tables.drawn[entry, 0]
        points[point, 2] += values[tables.parameter] * tables.drawn[entry, 1]
        up, forward = points[point, 1] - y, points[point, 2] - z
        points[point, 1] = y + cosine * up - sine * forward
        points[point, 2] = z + sine * up + cosine * forward
