"""The compiled inner loops of deformation, single precision; numba compiles them once and keeps them on disk.

Only imported where they run: importing numba takes half a second. Each has a numpy twin, its oracle in the tests:
``contract`` has those of :mod:`agentface.deform.combine`, ``vertex_normals`` that of :mod:`agentface.deform.normals`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from agentface.conventions import Doubles, Floats, Indices

LANES = 16
"""Vertices a block: the inner loops run over them, so that they fill whole vector registers."""

NOTHING = 1e-6
"""A contraction as small as this is none: 0.6 in single precision is three steps of 0.2, not four."""

_F = np.float32
_ZERO, _HALF, _ONE = _F(0.0), _F(0.5), _F(1.0)
_MARGIN = _F(1e-10)  # m^2, wider than rounding
# Keeps 1 / distance finite at a muscle's origin; its root, 1e-10 m, is far below single precision here.
_TINY = _F(1e-20)
# cos(pi/2 u) = (1 - u^2) (1 + Q1 u^2 + Q2 u^4 + Q3 u^6) on 0..1, exact at both ends, fitted to 6e-8.
_Q1, _Q2, _Q3 = _F(-0.2336987033), _F(0.0199532354), _F(-0.0008582032)


@njit(cache=True)
def slice_steps(contractions: Doubles, step: float, parts: Floats) -> int:
    """Fills ``parts (S, M)`` with slices of at most ``step``; returns the first contraction not in 0..1, or -1."""
    for muscle in range(contractions.shape[0]):
        contraction = contractions[muscle]
        if not 0.0 <= contraction <= 1.0:
            return muscle
        for index in range(parts.shape[0]):
            left = contraction - index * step if index else contraction
            parts[index, muscle] = min(step, left) if left > NOTHING else 0.0
    return -1


@njit(cache=True)
def spread(contractions: Doubles, step: float, parts: Floats) -> int:
    """Fills the diagonal of ``parts (M, M)``: one muscle a step; returns as :func:`slice_steps` does."""
    for muscle in range(contractions.shape[0]):
        contraction = contractions[muscle]
        if not 0.0 <= contraction <= 1.0:
            return muscle
        parts[muscle, muscle] = contraction
    return -1


@njit(cache=True, fastmath=True, error_model="numpy")
def contract(
    rest: Floats,
    home: Floats,
    vertex: Indices,
    first: Indices,
    owner: Indices,
    pull: Floats,
    fibre: Floats,
    parts: Floats,
    out: Floats,
) -> None:
    """Moves the vertices by a schedule of contractions; shapes as in :func:`agentface.deform.blocks.pack`.

    Args:
        rest: ``(V, 3)`` m.
        home: ``(B, 3, LANES)`` m, rest positions by block.
        vertex: ``(B, LANES)``, the vertex of each lane.
        first: ``(B + 1,)``, the range of pairs of each block.
        owner: ``(P,)``, the muscle of each pair.
        pull: ``(P, LANES)`` m, elasticity times reach.
        fibre: ``(M, 15)``, a muscle's constants.
        parts: ``(S, M)``, what contracts in each step.
        out: ``(V, 3)`` m.
    """
    still, moved = rest.ravel(), out.ravel()
    for index in range(still.shape[0]):
        moved[index] = still[index]
    steps, muscles = parts.shape
    at = np.empty((3, LANES), dtype=np.float32)
    change = np.empty((3, LANES), dtype=np.float32)
    active = np.empty(muscles, dtype=np.int32)
    ball = np.empty(4, dtype=np.float32)
    busy = np.zeros(muscles, dtype=np.bool_)
    for step in range(steps):
        for muscle in range(muscles):
            busy[muscle] |= parts[step, muscle] > _ZERO
    for block in range(home.shape[0]):
        count = 0
        for pair in range(first[block], first[block + 1]):
            if busy[owner[pair]]:
                active[count] = pair
                count += 1
        if count == 0:
            continue
        at[:] = home[block]
        for step in range(steps):
            change[:] = _ZERO
            enclose(at, ball)
            for index in range(count):
                pair = active[index]
                muscle = owner[pair]
                part = parts[step, muscle]
                if part > _ZERO and meets(fibre[muscle], ball):
                    pull_block(fibre[muscle], part, pull[pair], at, change)
            for lane in range(LANES):
                at[0, lane] -= change[0, lane]
                at[1, lane] -= change[1, lane]
                at[2, lane] -= change[2, lane]
        for lane in range(LANES):
            row = vertex[block, lane]
            out[row, 0] = at[0, lane]
            out[row, 1] = at[1, lane]
            out[row, 2] = at[2, lane]


@njit(cache=True, fastmath=True, error_model="numpy", inline="always")
def enclose(at: Floats, ball: Floats) -> None:
    """Sets ``ball (4,)`` to the centre and radius of a ball around the lanes of ``at (3, LANES)``."""
    square = _MARGIN
    for axis in range(3):
        low = at[axis, 0]
        high = at[axis, 0]
        for lane in range(LANES):
            low = min(low, at[axis, lane])
            high = max(high, at[axis, lane])
        ball[axis] = _HALF * (low + high)
        square += (_HALF * (high - low)) ** 2
    ball[3] = math.sqrt(square)


@njit(cache=True, fastmath=True, error_model="numpy", inline="always")
def meets(fibre: Floats, ball: Floats) -> bool:
    """Whether a ball may meet a muscle's zone: the ball around its origin, and the half plane around its cone."""
    x, y, z = ball[0] - fibre[0], ball[1] - fibre[1], ball[2] - fibre[2]
    square = x * x + y * y + z * z
    limit = fibre[14] + ball[3]
    if square > limit * limit:
        return False
    along = (x * fibre[3] + y * fibre[4] + z * fibre[5]) * fibre[13]
    aside = math.sqrt(max(square - along * along, _ZERO))
    return aside * fibre[12] - along * fibre[11] <= ball[3]


@njit(cache=True, fastmath=True, error_model="numpy", inline="always")
def pull_block(fibre: Floats, part: float, pull: Floats, at: Floats, change: Floats) -> None:
    ox, oy, oz = fibre[0], fibre[1], fibre[2]
    ax, ay, az, shift = fibre[3], fibre[4], fibre[5], fibre[6]
    rise, fall, start = fibre[7], fibre[8], fibre[9]
    slope, base = part * fibre[10], part * fibre[15]
    for lane in range(LANES):
        x, y, z = at[0, lane] - ox, at[1, lane] - oy, at[2, lane] - oz
        square = x * x + y * y + z * z + _TINY
        inverse = _ONE / math.sqrt(square)
        distance = square * inverse
        inside = (x * ax + y * ay + z * az) * inverse + shift
        u = min(max(_ONE - distance * rise, distance * fall - start), _ONE)
        q = u * u
        radial = (_ONE - q) * (_ONE + q * (_Q1 + q * (_Q2 + q * _Q3)))
        angular = inside * slope + base if inside >= _ZERO else _ZERO
        weight = pull[lane] * inverse * angular * radial
        change[0, lane] += weight * x
        change[1, lane] += weight * y
        change[2, lane] += weight * z
