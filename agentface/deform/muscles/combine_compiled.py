"""The vector muscles' loop, single precision; its numpy twins are in :mod:`agentface.deform.muscles.combine`."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.muscles.blocks import FIELDS, Blocks
from agentface.deform.muscles.vector_muscle import NOTHING
from agentface.deform.simd import (
    inverse_root,
    larger,
    largest,
    load,
    smaller,
    splat,
    store,
    where_positive,
)
from agentface.kernel import kernel

_F = np.float32
_ZERO, _ONE = _F(0.0), _F(1.0)
_MARGIN = _F(1e-5)  # m, wider than the rounding of a sum of displacements
# Keeps 1 / distance finite at a muscle's origin; its root, 1e-10 m, is far below single precision here.
_TINY = _F(1e-20)
# cos(pi/2 u) = (1 - u^2) (1 + Q1 u^2 + Q2 u^4 + Q3 u^6) on 0..1, exact at both ends, fitted to 6e-8.
_Q1, _Q2, _Q3 = _F(-0.2336987033), _F(0.0199532354), _F(-0.0008582032)


@kernel()
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


@kernel()
def spread(contractions: Doubles, step: float, parts: Floats) -> int:
    """Fills the diagonal of ``parts (M, M)``: one muscle a step; returns as :func:`slice_steps` does."""
    for muscle in range(contractions.shape[0]):
        contraction = contractions[muscle]
        if not 0.0 <= contraction <= 1.0:
            return muscle
        parts[muscle, muscle] = contraction
    return -1


@kernel()
def contract(rest: Floats, blocks: Blocks, parts: Floats, shares: Floats, found: Floats, out: Floats) -> None:
    """Moves the vertices, ``rest (V, 3)`` m, by a schedule of contractions ``parts (S, M)``, to ``out (V, 3)`` m.

    ``shares (S + 1, J)`` and ``found (K, J)`` m are those of :meth:`.combine.Combiner.apply`.
    """
    others = rest.shape[0] - found.shape[0]
    _stay(rest, found, out)
    whole = np.zeros(parts.shape[1], dtype=np.float32)
    acts = np.zeros(parts.shape[1], dtype=np.int64)
    for step in range(parts.shape[0]):
        for muscle in range(parts.shape[1]):
            whole[muscle] += parts[step, muscle]
            acts[muscle] |= parts[step, muscle] > _ZERO
    lanes = np.empty((3 + parts.shape[0]) * LANES, dtype=np.float32)
    pairs = np.empty(parts.shape[1] + 1, dtype=np.int32)
    muscles = np.empty(parts.shape[1] + 1, dtype=np.int32)
    bounds = np.empty(parts.shape[1] + 1, dtype=np.float32)
    for block in range(blocks.home.shape[0]):
        count = 0
        travel = _MARGIN
        for pair in range(blocks.first[block], blocks.first[block + 1]):
            if blocks.slack[pair] > travel:
                break
            muscle = blocks.owner[pair]
            pairs[count], muscles[count], bounds[count] = pair, muscle, blocks.slack[pair]
            count += acts[muscle]
            travel += whole[muscle] * blocks.strongest[pair]
        if count and bounds[0] == _ZERO:
            contract_block(blocks.home, block, pairs, muscles, bounds, count, blocks.pull, blocks.fibre, parts, lanes)
            for lane in range(LANES):
                row = blocks.vertex[block, lane]
                out[row, 0] = lanes[lane]
                out[row, 1] = lanes[LANES + lane]
                out[row, 2] = lanes[2 * LANES + lane]
                if row >= others:
                    _find(lanes[lane::LANES], shares, found[row - others])


@kernel()
def _stay(rest: Floats, found: Floats, out: Floats) -> None:
    still, moved = rest.ravel(), out.ravel()
    for index in range(still.shape[0]):
        moved[index] = still[index]
    others = rest.shape[0] - found.shape[0]
    for row in range(found.shape[0]):
        found[row] = rest[others + row, 0]


@kernel()
def _find(lane: Floats, shares: Floats, found: Floats) -> None:
    """The mean x of a vertex whose ``lane`` is its x, y, z at last and its x before each step."""
    for other in range(found.shape[0]):
        x = shares[-1, other] * lane[0]
        for step in range(shares.shape[0] - 1):
            x += shares[step, other] * lane[3 + step]
        found[other] = x


@kernel(fastmath=True, error_model="numpy")
def contract_block(
    home: Floats,
    block: int,
    pairs: Indices,
    muscles: Indices,
    bounds: Floats,
    count: int,
    pull: Floats,
    fibre: Floats,
    parts: Floats,
    lanes: Floats,
) -> None:
    """Writes to ``lanes`` where the schedule takes one block by the first ``count`` of ``pairs``, nearest first.

    Behind x, y and z come the x before each step.
    A muscle that the block has not travelled far enough to meet is left out, and those behind it with it. The radial
    fall-off needs no branch: of its rising and falling argument the larger is the one that holds.
    """
    start = block * 3 * LANES
    hx, hy, hz = load(home, start), load(home, start + LANES), load(home, start + 2 * LANES)
    px, py, pz = hx, hy, hz
    travel = _ZERO
    for step in range(parts.shape[0]):
        store(lanes, (3 + step) * LANES, px)
        dx, dy, dz = splat(_ZERO), splat(_ZERO), splat(_ZERO)
        for index in range(count):
            if bounds[index] > travel:
                break
            muscle = muscles[index]
            part = parts[step, muscle]
            if part == _ZERO:
                continue
            at = muscle * FIELDS * LANES
            x, y, z = px - load(fibre, at), py - load(fibre, at + 1 * LANES), pz - load(fibre, at + 2 * LANES)
            square = z * z + (y * y + (x * x + _TINY))
            inverse = inverse_root(square)
            distance = square * inverse
            along = x * load(fibre, at + 3 * LANES) + y * load(fibre, at + 4 * LANES) + z * load(fibre, at + 5 * LANES)
            angular = along * inverse + load(fibre, at + 6 * LANES)
            base = fibre[muscle, 11, 0]
            if base == _ZERO:
                angular = larger(angular, splat(_ZERO))
            else:
                angular = where_positive(angular, angular * load(fibre, at + 10 * LANES) + base)
            rising = _ONE - distance * load(fibre, at + 7 * LANES)
            falling = distance * load(fibre, at + 8 * LANES) - load(fibre, at + 9 * LANES)
            u = smaller(larger(rising, falling), splat(_ONE))
            q = u * u
            radial = (_ONE - q) * (_ONE + q * (_Q1 + q * (_Q2 + q * _Q3)))
            weight = load(pull, pairs[index] * LANES) * part * inverse * angular * radial
            dx, dy, dz = dx + weight * x, dy + weight * y, dz + weight * z
        px, py, pz = px - dx, py - dy, pz - dz
        x, y, z = px - hx, py - hy, pz - hz
        travel = _F(math.sqrt(largest(x * x + y * y + z * z)))
    store(lanes, 0, px)
    store(lanes, LANES, py)
    store(lanes, 2 * LANES, pz)
