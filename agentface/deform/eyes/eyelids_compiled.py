"""The lids' loop, single precision; the numpy twin is :mod:`agentface.deform.eyes.eyelids`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.eyes import eyelids
from agentface.deform.eyes.eyeballs import FARTHEST
from agentface.deform.eyes.eyeballs_compiled import eye_angles
from agentface.deform.eyes.eyelids import (
    ACROSS,
    CLOSE,
    FLOOR,
    FOLLOW,
    HIGHER,
    HOLD,
    LOOKING_UP,
    SHRINK,
    SHRINK_HIGHER,
    SLANT,
    TIGHT_ACROSS,
    TIGHT_UP,
    TIGHTEN,
    UP,
    WIDEN,
    EyelidsTables,
)
from agentface.deform.lanes import LANES
from agentface.deform.simd import inverse_root, larger, load, splat
from agentface.deform.simd_rows import put_columns, put_row, put_wide_row, row_at, wide_row_at, xs_of, ys_of, zs_of
from agentface.kernel import kernel

FIELDS = FLOOR + 1
_F = np.float32
_ZERO, _ONE, _TWO = _F(0.0), _F(1.0), _F(2.0)
_TINY = _F(1e-12)  # m^2
# Taylor's series in the angle's square: to 1e-8 of the sine and 1e-7 of the cosine up to 1.3 rad, past any lid's turn.
_S1, _S2, _S3, _S4, _S5 = (_F(number) for number in (-1 / 6, 1 / 120, -1 / 5040, 1 / 362880, -1 / 39916800))
_C1, _C2, _C3, _C4, _C5 = (_F(number) for number in (-1 / 2, 1 / 24, -1 / 720, 1 / 40320, -1 / 3628800))

_coupled = kernel(error_model="numpy")(eyelids.coupled)


@kernel(error_model="numpy")
def apply(tables: EyelidsTables, values: Floats, points: Floats) -> None:
    """Move the lids and what they take along of ``points (V + C, 3)`` m in place, to the parameters ``values``."""
    for side in range(2):
        own_close, own_squeeze = values[tables.closing[side]], values[tables.squeezing[side]]
        other_close, other_squeeze = values[tables.closing[1 - side]], values[tables.squeezing[1 - side]]
        closed, squeezed = _coupled(own_close, own_squeeze, other_close, other_squeeze)
        c, s, o = _F(closed), _F(squeezed), values[tables.opening[side]]
        pitch = _F(eye_angles(tables.eyes, values, side)[1])
        if pitch > _ZERO:
            pitch *= _ONE - LOOKING_UP * o
        way = s * (_TWO - s)
        alone = max(values[tables.inner_brow[side]] - values[tables.outer_brow[side]], _ZERO)
        turns = (_ONE - c) * o, (_ONE - c) * pitch, (_ONE - c) * values[tables.tightening[side]], (_ONE - c) * alone
        ahead = FARTHEST * values[tables.eyes.thrust[side]]
        levels = c, min(_ONE, _TWO * s), *turns, way, _F(1 - 2 * side), ahead
        _move(tables.vertex[side], tables.rest[side], tables.centre[side], tables.fields, levels, points)


@kernel(fastmath=True, error_model="numpy")
def _move(
    vertex: Indices, rest: Floats, centre: Floats, fields: Floats, levels: tuple[np.float32, ...], points: Floats
) -> None:
    c, raised, o, pitch, tight, alone, way, side, ahead = levels
    cx, cy, cz = splat(centre[0]), splat(centre[1]), splat(centre[2])
    rows = np.empty((LANES, 4), dtype=np.float32)
    for block in range(vertex.shape[0]):
        for lane in range(LANES):
            put_wide_row(rows, 4 * lane, row_at(points, 3 * vertex[block, lane]))
        first, home = block * FIELDS * LANES, block * 3 * LANES
        kept = _ONE - load(fields, first + HOLD * LANES)
        hx, hy, hz = load(rest, home), load(rest, home + LANES), load(rest, home + 2 * LANES)
        across = load(fields, first + ACROSS * LANES) * way + load(fields, first + TIGHT_ACROSS * LANES) * tight
        up = load(fields, first + UP * LANES) * way + load(fields, first + TIGHT_UP * LANES) * tight
        x = hx + kept * (xs_of(rows, 0) - hx) + across * side
        y = hy + kept * (ys_of(rows, 0) - hy) + up
        z = hz + kept * (zs_of(rows, 0) - hz)
        angle = load(fields, first + CLOSE * LANES) * c + load(fields, first + HIGHER * LANES) * raised
        angle = angle + load(fields, first + WIDEN * LANES) * o + load(fields, first + FOLLOW * LANES) * pitch
        angle = angle + load(fields, first + TIGHTEN * LANES) * tight + load(fields, first + SLANT * LANES) * alone
        scale = load(fields, first + SHRINK * LANES) * c + load(fields, first + SHRINK_HIGHER * LANES) * raised + _ONE
        q = angle * angle
        cosine = scale * (_ONE + q * (_C1 + q * (_C2 + q * (_C3 + q * (_C4 + q * _C5))))) - _ONE
        sine = scale * angle * (_ONE + q * (_S1 + q * (_S2 + q * (_S3 + q * (_S4 + q * _S5)))))
        ay, az = y - cy, z - cz
        y, z = y + cosine * ay + sine * az, z + cosine * az - sine * ay
        z = z + load(fields, first + HOLD * LANES) * ahead
        ax, ay, az = x - cx, y - cy, z - (cz + splat(ahead))
        inverse = inverse_root(larger(ax * ax + ay * ay + az * az, splat(_TINY)))
        outward = larger(load(fields, first + FLOOR * LANES) * inverse, splat(_ONE)) - _ONE
        put_columns(rows, 0, x + outward * ax, y + outward * ay, z + outward * az)
        for lane in range(LANES):
            put_row(points, 3 * vertex[block, lane], wide_row_at(rows, 4 * lane))
