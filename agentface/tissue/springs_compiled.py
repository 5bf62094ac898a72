"""Springs and prisms of LANES columns at once: what the solvers' kernels are made of.

Three vectors are a point; a column is nine. The laws are those of :mod:`agentface.tissue.forces`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.deform.lanes import LANES
from agentface.deform.simd import choose, gather, inverse_root, larger, load, splat
from agentface.kernel import kernel
from agentface.tissue.columns import NODES
from agentface.tissue.forces import CRUSHED

_F = np.float32
ZERO, ONE, HALF = _F(0.0), _F(1.0), _F(0.5)
_TWO, _THREE, _FIVE = _F(2.0), _F(3.0), _F(5.0)
_TINY = _F(1e-12)
_CRUSHED = _F(CRUSHED)
_CRUSHED_PRESSURE, _CRUSHED_SLOPE = _F(0.5 * (CRUSHED - 1.0 / CRUSHED)), _F(0.5 * (1.0 + 1.0 / CRUSHED**2))
_SHARE = _F(1.0 / 36.0)


@kernel(error_model="numpy", inline="always", fastmath=True)
def column(positions: Any, batch: Any) -> Any:
    """The nine coordinates of a batch."""
    at = batch * NODES * LANES
    return (
        load(positions, at),
        load(positions, at + LANES),
        load(positions, at + 2 * LANES),
        load(positions, at + 3 * LANES),
        load(positions, at + 4 * LANES),
        load(positions, at + 5 * LANES),
        load(positions, at + 6 * LANES),
        load(positions, at + 7 * LANES),
        load(positions, at + 8 * LANES),
    )


@kernel(error_model="numpy", inline="always", fastmath=True)
def neighbours(positions: Any, places: Any, row: Any) -> Any:
    """The nine coordinates of a batch's neighbours in row ``row`` of the rings."""
    at = row * LANES
    return (
        gather(positions, places, at, 0),
        gather(positions, places, at, LANES),
        gather(positions, places, at, 2 * LANES),
        gather(positions, places, at, 3 * LANES),
        gather(positions, places, at, 4 * LANES),
        gather(positions, places, at, 5 * LANES),
        gather(positions, places, at, 6 * LANES),
        gather(positions, places, at, 7 * LANES),
        gather(positions, places, at, 8 * LANES),
    )


@kernel(error_model="numpy", inline="always", fastmath=True)
def tension(square: Any, pull: Any, inverse: Any, law: Any) -> Any:
    """Of a spring with the ``square`` of its length: tension over length, the slope of the tension, 1 / length.

    Both have what holds the spring's direction; its constant part is the column's ``steady``.
    """
    over = inverse_root(square + splat(_TINY))
    strain = square * over * inverse - ONE
    hard = strain * strain * law[0]
    stiff = pull * (ONE + hard * (law[1] + hard * law[2]))
    soft = pull * inverse
    slope = soft * (ONE + law[6] + hard * (_THREE * law[1] + hard * (_FIVE * law[2])))
    return stiff * strain * over + law[6] * soft, slope, over


@kernel(error_model="numpy", inline="always", fastmath=True)
def pressed(volume: Any) -> Any:
    """The pressure at a relative volume, and its slope."""
    safe = larger(volume, splat(_CRUSHED))
    over = ONE / safe
    low, slope = HALF * (safe - over), HALF * (ONE + over * over)
    crushed = volume - _CRUSHED
    low = choose(crushed, low, _CRUSHED_PRESSURE + _CRUSHED_SLOPE * crushed)
    swollen = volume - ONE
    return choose(swollen, swollen, low), choose(swollen, splat(ONE), slope)


@kernel(error_model="numpy", inline="always", fastmath=True)
def prism(own: Any, one: Any, other: Any) -> Any:
    """Of the prism between a column and two neighbours: its volume, and how that changes with the column's nodes."""
    ax, ay, az = one[0] - own[0], one[1] - own[1], one[2] - own[2]
    bx, by, bz = other[0] - own[0], other[1] - own[1], other[2] - own[2]
    cx, cy, cz = one[6] - own[6], one[7] - own[7], one[8] - own[8]
    dx, dy, dz = other[6] - own[6], other[7] - own[7], other[8] - own[8]
    hx = own[6] + one[6] + other[6] - own[0] - one[0] - other[0]
    hy = own[7] + one[7] + other[7] - own[1] - one[1] - other[1]
    hz = own[8] + one[8] + other[8] - own[2] - one[2] - other[2]
    px, py, pz = _TWO * bx + dx, _TWO * by + dy, _TWO * bz + dz
    qx, qy, qz = _TWO * dx + bx, _TWO * dy + by, _TWO * dz + bz
    nx = ay * pz - az * py + cy * qz - cz * qy
    ny = az * px - ax * pz + cz * qx - cx * qz
    nz = ax * py - ay * px + cx * qy - cy * qx
    ux, uy, uz = ax - bx, ay - by, az - bz
    vx, vy, vz = cx - dx, cy - dy, cz - dz
    sx, sy, sz = _TWO * ux + vx, _TWO * uy + vy, _TWO * uz + vz
    tx, ty, tz = _TWO * vx + ux, _TWO * vy + uy, _TWO * vz + uz
    volume = splat(ZERO) - (hx * nx + hy * ny + hz * nz) * _SHARE
    gradients = (
        (nx - sy * hz + sz * hy) * _SHARE,
        (ny - sz * hx + sx * hz) * _SHARE,
        (nz - sx * hy + sy * hx) * _SHARE,
        splat(ZERO) - (nx + ty * hz - tz * hy) * _SHARE,
        splat(ZERO) - (ny + tz * hx - tx * hz) * _SHARE,
        splat(ZERO) - (nz + tx * hy - ty * hx) * _SHARE,
    )
    return volume, gradients
