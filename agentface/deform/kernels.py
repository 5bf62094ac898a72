"""The compiled inner loops of deformation, single precision; numba compiles them once and keeps them on disk.

Only imported where they run: importing numba takes half a second. Each has a numpy twin, its oracle in the tests:
``contract`` has those of :mod:`agentface.deform.combine`, ``vertex_normals`` that of :mod:`agentface.deform.normals`.
"""

from __future__ import annotations

import math

import numpy as np
from numba import njit

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.combine import NOTHING

LANES = 64
"""Vertices a block: the inner loops run over them, so that they fill whole vector registers."""

# One array holds a block's positions and their changes, because the compiler then knows that they do not overlap.
_Y, _Z, _DX, _DY, _DZ = LANES, 2 * LANES, 3 * LANES, 4 * LANES, 5 * LANES
_F = np.float32
_ZERO, _HALF, _ONE = _F(0.0), _F(0.5), _F(1.0)
_MARGIN = _F(1e-10)  # m^2, wider than rounding
_SMALLEST = _F(1e-36)  # m^4, near the end of single precision
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
        home: ``(B, 3 * LANES)`` m, rest positions by block: all x, all y, all z.
        vertex: ``(B, LANES)``, the vertex of each lane.
        first: ``(B + 1,)``, the range of pairs of each block.
        owner: ``(P,)``, the muscle of each pair.
        pull: ``(P, LANES)`` m, elasticity times reach.
        fibre: ``(M, 16)``, a muscle's constants.
        parts: ``(S, M)``, what contracts in each step.
        out: ``(V, 3)`` m.
    """
    still, moved = rest.ravel(), out.ravel()
    for index in range(still.shape[0]):
        moved[index] = still[index]
    lanes = np.empty(6 * LANES, dtype=np.float32)
    ball = np.empty(4, dtype=np.float32)
    busy = np.zeros(parts.shape[1], dtype=np.bool_)
    acting = np.empty(parts.shape[1], dtype=np.int32)
    for step in range(parts.shape[0]):
        for muscle in range(parts.shape[1]):
            busy[muscle] |= parts[step, muscle] > _ZERO
    for block in range(home.shape[0]):
        count = 0
        for pair in range(first[block], first[block + 1]):
            if busy[owner[pair]]:
                acting[count] = pair
                count += 1
        if count == 0:
            continue
        for index in range(_DX):
            lanes[index] = home[block, index]
        for step in range(parts.shape[0]):
            contract_block(acting, count, owner, pull, fibre, parts, step, lanes, ball)
        store_block(lanes, vertex, block, out)


@njit(cache=True)
def store_block(lanes: Floats, vertex: Indices, block: int, out: Floats) -> None:
    """Writes the positions of one block to its vertices."""
    for lane in range(LANES):
        row = vertex[block, lane]
        out[row, 0] = lanes[lane]
        out[row, 1] = lanes[_Y + lane]
        out[row, 2] = lanes[_Z + lane]


@njit(cache=True, fastmath=True, error_model="numpy")
def contract_block(
    acting: Indices,
    count: int,
    owner: Indices,
    pull: Floats,
    fibre: Floats,
    parts: Floats,
    step: int,
    lanes: Floats,
    ball: Floats,
) -> None:
    """One step of one block with the first ``count`` pairs of ``acting``; a muscle out of reach is left out."""
    for index in range(_DX, 6 * LANES):
        lanes[index] = _ZERO
    enclose(lanes, ball)
    for index in range(count):
        pair = acting[index]
        muscle = owner[pair]
        part = parts[step, muscle]
        if part > _ZERO and meets(fibre, muscle, ball):
            pull_block(fibre, muscle, part, pull, pair, lanes)
    for index in range(_DX):
        lanes[index] -= lanes[_DX + index]


@njit(cache=True, fastmath=True, error_model="numpy")
def enclose(lanes: Floats, ball: Floats) -> None:
    """Sets ``ball (4,)`` to the centre and radius of a ball around the vertices of a block."""
    square = _MARGIN
    for axis in range(3):
        low = lanes[axis * LANES]
        high = low
        for index in range(axis * LANES, axis * LANES + LANES):
            low = min(low, lanes[index])
            high = max(high, lanes[index])
        ball[axis] = _HALF * (low + high)
        square += (_HALF * (high - low)) ** 2
    ball[3] = math.sqrt(square)


@njit(cache=True, fastmath=True, error_model="numpy")
def meets(fibre: Floats, muscle: int, ball: Floats) -> bool:
    """Whether a ball may meet a muscle's zone: the ball around its origin, and the half space that holds its cone."""
    x, y, z = ball[0] - fibre[muscle, 0], ball[1] - fibre[muscle, 1], ball[2] - fibre[muscle, 2]
    square = x * x + y * y + z * z
    limit = fibre[muscle, 15] + ball[3]
    if square > limit * limit:
        return False
    along = (x * fibre[muscle, 3] + y * fibre[muscle, 4] + z * fibre[muscle, 5]) * fibre[muscle, 14]
    aside = math.sqrt(max(square - along * along, _ZERO))
    inside: bool = aside * fibre[muscle, 13] - along * fibre[muscle, 12] <= ball[3]
    return inside


@njit(cache=True, fastmath=True, error_model="numpy")
def pull_block(fibre: Floats, muscle: int, part: float, pull: Floats, pair: int, lanes: Floats) -> None:
    """Adds one muscle's pull, away from its origin and to be subtracted, to the changes of a block.

    The radial fall-off needs no branch: of its rising and falling argument the larger is the one that holds. The
    smooth angular fall-off needs none either; that with a cliff has a loop of its own, which is a third slower.
    """
    ox, oy, oz = fibre[muscle, 0], fibre[muscle, 1], fibre[muscle, 2]
    rise, fall, start = fibre[muscle, 7], fibre[muscle, 8], fibre[muscle, 9]
    slope, base = part * fibre[muscle, 10], part * fibre[muscle, 11]
    ax, ay, az = slope * fibre[muscle, 3], slope * fibre[muscle, 4], slope * fibre[muscle, 5]
    shift = slope * fibre[muscle, 6]
    if base != _ZERO:
        pull_block_cliff(fibre, muscle, part, pull, pair, lanes)
        return
    for lane in range(LANES):
        x, y, z = lanes[lane] - ox, lanes[_Y + lane] - oy, lanes[_Z + lane] - oz
        square = x * x + y * y + (z * z + _TINY)
        inverse = _ONE / math.sqrt(square)
        distance = square * inverse
        angular = max((x * ax + y * ay + z * az) * inverse + shift, _ZERO)
        u = min(max(_ONE - distance * rise, distance * fall - start), _ONE)
        q = u * u
        radial = (_ONE - q) * (_ONE + q * (_Q1 + q * (_Q2 + q * _Q3)))
        weight = pull[pair, lane] * inverse * angular * radial
        lanes[_DX + lane] += weight * x
        lanes[_DY + lane] += weight * y
        lanes[_DZ + lane] += weight * z


@njit(cache=True, fastmath=True, error_model="numpy")
def pull_block_cliff(fibre: Floats, muscle: int, part: float, pull: Floats, pair: int, lanes: Floats) -> None:
    """As :func:`pull_block`, for an angular fall-off that is not zero at the edge of the zone (Waters)."""
    ox, oy, oz = fibre[muscle, 0], fibre[muscle, 1], fibre[muscle, 2]
    ax, ay, az, shift = fibre[muscle, 3], fibre[muscle, 4], fibre[muscle, 5], fibre[muscle, 6]
    rise, fall, start = fibre[muscle, 7], fibre[muscle, 8], fibre[muscle, 9]
    slope, base = part * fibre[muscle, 10], part * fibre[muscle, 11]
    for lane in range(LANES):
        x, y, z = lanes[lane] - ox, lanes[_Y + lane] - oy, lanes[_Z + lane] - oz
        square = x * x + y * y + z * z + _TINY
        inverse = _ONE / math.sqrt(square)
        distance = square * inverse
        inside = (x * ax + y * ay + z * az) * inverse + shift
        u = min(max(_ONE - distance * rise, distance * fall - start), _ONE)
        q = u * u
        radial = (_ONE - q) * (_ONE + q * (_Q1 + q * (_Q2 + q * _Q3)))
        angular = inside * slope + base if inside >= _ZERO else _ZERO
        weight = pull[pair, lane] * inverse * angular * radial
        lanes[_DX + lane] += weight * x
        lanes[_DY + lane] += weight * y
        lanes[_DZ + lane] += weight * z


@njit(cache=True, fastmath=True, error_model="numpy")
def vertex_normals(vertices: Floats, triangles: Indices, out: Floats) -> None:
    """Area-weighted unit normals of ``vertices (V, 3)``; a vertex without area gets zero."""
    for vertex in range(out.shape[0]):
        out[vertex, 0] = _ZERO
        out[vertex, 1] = _ZERO
        out[vertex, 2] = _ZERO
    for triangle in range(triangles.shape[0]):
        a, b, c = triangles[triangle, 0], triangles[triangle, 1], triangles[triangle, 2]
        x, y, z = vertices[a, 0], vertices[a, 1], vertices[a, 2]
        ux, uy, uz = vertices[b, 0] - x, vertices[b, 1] - y, vertices[b, 2] - z
        vx, vy, vz = vertices[c, 0] - x, vertices[c, 1] - y, vertices[c, 2] - z
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        for corner in (a, b, c):
            out[corner, 0] += nx
            out[corner, 1] += ny
            out[corner, 2] += nz
    for vertex in range(out.shape[0]):
        square = out[vertex, 0] ** 2 + out[vertex, 1] ** 2 + out[vertex, 2] ** 2
        scale = _ONE / math.sqrt(square) if square > _SMALLEST else _ZERO
        out[vertex, 0] *= scale
        out[vertex, 1] *= scale
        out[vertex, 2] *= scale
