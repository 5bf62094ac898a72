"""Block descent: each column, in its turn, goes to where its nine coordinates are in equilibrium with the others.

A Newton step a column on the energy, by the newest places of its neighbours (Gauss and Seidel), longer than 1 to
converge faster (over-relaxation). Columns of a batch are not beside each other and go together.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.simd import choose, inverse_root, larger, largest, load, splat, store
from agentface.kernel import kernel
from agentface.tissue.columns import AROUND, NODES, Columns
from agentface.tissue.forces_compiled import held
from agentface.tissue.springs_compiled import ONE, ZERO, column, neighbours, pressed, prism, tension
from agentface.tissue.tissue_file import FORMS

_COMPONENTS, _SPRINGS = 3, len(AROUND)
_ENERGY = FORMS.index("energy")
_TRIANGLE = NODES * (NODES + 1) // 2
_STRETCH = 128 * LANES
_NOTHING = np.float32(1e-20)
_SINGULAR = np.float32(1e-6)
"""What a lane without a column has on its diagonal."""


@kernel(error_model="numpy", inline="always", fastmath=True)
def bent(state: Any, node: Any, other: Any, pull: Any, inverse: Any, law: Any) -> Any:
    """A node's force (3) and block of stiffness (6: xx yx yy zx zy zz) with one spring more."""
    x, y, z = node[0] - other[0], node[1] - other[1], node[2] - other[2]
    side, slope, over = tension(x * x + y * y + z * z, pull, inverse, law)
    least = larger(side, splat(ZERO))
    more = (slope - least) * over * over
    mx, my = more * x, more * y
    return (
        state[0] - side * x,
        state[1] - side * y,
        state[2] - side * z,
        state[3] + least + mx * x,
        state[4] + mx * y,
        state[5] + least + my * y,
        state[6] + mx * z,
        state[7] + my * z,
        state[8] + least + more * z * z,
    )


@kernel(error_model="numpy", inline="always", fastmath=True)
def joined(node: Any, other: Any, pull: Any, inverse: Any, law: Any) -> Any:
    """What a spring within a column adds to its two nodes: the force on the first, and the block of stiffness."""
    zero = splat(ZERO)
    return bent((zero, zero, zero, zero, zero, zero, zero, zero, zero), node, other, pull, inverse, law)


@kernel(error_model="numpy", inline="always", fastmath=True)
def plus(state: Any, more: Any, sign: Any) -> Any:
    """``state`` with the force of ``more``, times ``sign``, and its stiffness."""
    return (
        state[0] + sign * more[0],
        state[1] + sign * more[1],
        state[2] + sign * more[2],
        state[3] + more[3],
        state[4] + more[4],
        state[5] + more[5],
        state[6] + more[6],
        state[7] + more[7],
        state[8] + more[8],
    )


@kernel(error_model="numpy", inline="always", fastmath=True)
def pushed(state: Any, x: Any, y: Any, z: Any, push: Any, slope: Any) -> Any:
    """``state`` with a prism's force along its gradient and the stiffness of its pressure."""
    sx, sy = slope * x, slope * y
    return (
        state[0] + push * x,
        state[1] + push * y,
        state[2] + push * z,
        state[3] + sx * x,
        state[4] + sx * y,
        state[5] + sy * y,
        state[6] + sx * z,
        state[7] + sy * z,
        state[8] + slope * z * z,
    )


@kernel(error_model="numpy", fastmath=True)
def step(matrix: Floats, force: Floats) -> None:
    """Solves ``matrix`` times a step = ``force`` for LANES columns, in place, by Cholesky's factors.

    ``matrix (45, LANES)`` is the lower triangle, row after row; ``force (9, LANES)`` becomes the step.
    """
    for i in range(NODES):
        row = i * (i + 1) // 2
        for j in range(i):
            other = j * (j + 1) // 2
            value = load(matrix, (row + j) * LANES)
            for k in range(j):
                value = value - load(matrix, (row + k) * LANES) * load(matrix, (other + k) * LANES)
            store(matrix, (row + j) * LANES, value * load(matrix, (other + j) * LANES))
        value = load(matrix, (row + i) * LANES)
        for k in range(i):
            part = load(matrix, (row + k) * LANES)
            value = value - part * part
        store(matrix, (row + i) * LANES, inverse_root(larger(value, splat(_SINGULAR))))
        value = load(force, i * LANES)
        for k in range(i):
            value = value - load(matrix, (row + k) * LANES) * load(force, k * LANES)
        store(force, i * LANES, value * load(matrix, (row + i) * LANES))
    for back in range(NODES):
        i = NODES - 1 - back
        value = load(force, i * LANES)
        for k in range(i + 1, NODES):
            value = value - load(matrix, (k * (k + 1) // 2 + i) * LANES) * load(force, k * LANES)
        store(force, i * LANES, value * load(matrix, (i * (i + 1) // 2 + i) * LANES))


@kernel(error_model="numpy", inline="always", fastmath=True)
def put_block(matrix: Any, node: Any, state: Any) -> Any:
    """Writes a node's own block into the lower triangle."""
    row = 3 * node
    store(matrix, (row * (row + 1) // 2 + row) * LANES, state[3])
    row += 1
    at = (row * (row + 1) // 2 + 3 * node) * LANES
    store(matrix, at, state[4])
    store(matrix, at + LANES, state[5])
    row += 1
    at = (row * (row + 1) // 2 + 3 * node) * LANES
    store(matrix, at, state[6])
    store(matrix, at + LANES, state[7])
    store(matrix, at + 2 * LANES, state[8])


@kernel(error_model="numpy", inline="always", fastmath=True)
def put_between(matrix: Any, node: Any, other: Any, state: Any) -> Any:
    """Writes the block between two nodes of a column that one spring joins: its stiffness, with its sign turned."""
    zero = splat(ZERO)
    row = 3 * node
    at = (row * (row + 1) // 2 + 3 * other) * LANES
    store(matrix, at, zero - state[3])
    store(matrix, at + LANES, zero - state[4])
    store(matrix, at + 2 * LANES, zero - state[6])
    row += 1
    at = (row * (row + 1) // 2 + 3 * other) * LANES
    store(matrix, at, zero - state[4])
    store(matrix, at + LANES, zero - state[5])
    store(matrix, at + 2 * LANES, zero - state[7])
    row += 1
    at = (row * (row + 1) // 2 + 3 * other) * LANES
    store(matrix, at, zero - state[6])
    store(matrix, at + LANES, zero - state[7])
    store(matrix, at + 2 * LANES, zero - state[8])


@kernel(error_model="numpy", inline="always", fastmath=True)
def put_crossing(matrix: Any, block: Any) -> Any:
    """Writes the block between hypodermis (rows) and epidermis of a column, which prisms join."""
    for row in range(3):
        at = ((6 + row) * (7 + row) // 2) * LANES
        store(matrix, at, block[3 * row])
        store(matrix, at + LANES, block[3 * row + 1])
        store(matrix, at + 2 * LANES, block[3 * row + 2])


@kernel(error_model="numpy", inline="always", fastmath=True)
def crossed(block: Any, slopes: Any, slope: Any) -> Any:
    """That block with one prism more."""
    ux, uy, uz, lx, ly, lz = slopes
    sx, sy, sz = slope * lx, slope * ly, slope * lz
    return (
        block[0] + sx * ux, block[1] + sx * uy, block[2] + sx * uz,
        block[3] + sy * ux, block[4] + sy * uy, block[5] + sy * uz,
        block[6] + sz * ux, block[7] + sz * uy, block[8] + sz * uz,
    )  # fmt: skip


@kernel(error_model="numpy", inline="always", fastmath=True)
def surrounded(columns: Any, batch: Any, own: Any, positions: Any) -> Any:
    """What the neighbours do to a batch: a state (force, stiffness) a layer, and the block that prisms join."""
    law, zero, whole = columns.law, splat(ZERO), int(columns.law[5]) == _ENERGY
    pull, inverse = columns.pull, columns.inverse
    e, d, h = (own[0], own[1], own[2]), (own[3], own[4], own[5]), (own[6], own[7], own[8])
    steady = column(columns.steady, batch)
    epidermis = (steady[0], steady[1], steady[2], zero, zero, zero, zero, zero, zero)
    dermis = (steady[3], steady[4], steady[5], zero, zero, zero, zero, zero, zero)
    hypodermis = (steady[6], steady[7], steady[8], zero, zero, zero, zero, zero, zero)
    block = (zero, zero, zero, zero, zero, zero, zero, zero, zero)
    first, last = columns.first[batch], columns.first[batch + 1]
    before = neighbours(positions, columns.neighbour, last - 1)
    for row in range(first, last):
        there = neighbours(positions, columns.neighbour, row)
        if whole:
            volume, slopes = prism(own, before, there)
            over = load(columns.volume, (last - 1 if row == first else row - 1) * LANES)
            pressure, slope = pressed(volume * over)
            exists = over * over * inverse_root(over * over * over * over + _NOTHING)
            push, slope = zero - law[3] * exists * pressure, law[3] * slope * over
            epidermis = pushed(epidermis, slopes[0], slopes[1], slopes[2], push, slope)
            hypodermis = pushed(hypodermis, slopes[3], slopes[4], slopes[5], push, slope)
            block = crossed(block, slopes, slope)
        before = there
        ne, nd, nh = (there[0], there[1], there[2]), (there[3], there[4], there[5]), (there[6], there[7], there[8])
        at = row * _SPRINGS * LANES
        epidermis = bent(epidermis, e, ne, load(pull, at), load(inverse, at), law)
        at += LANES
        dermis = bent(dermis, d, nd, load(pull, at), load(inverse, at), law)
        at += LANES
        hypodermis = bent(hypodermis, h, nh, load(pull, at), load(inverse, at), law)
        at += LANES
        epidermis = bent(epidermis, e, nd, load(pull, at), load(inverse, at), law)
        at += LANES
        dermis = bent(dermis, d, ne, load(pull, at), load(inverse, at), law)
        at += LANES
        dermis = bent(dermis, d, nh, load(pull, at), load(inverse, at), law)
        at += LANES
        hypodermis = bent(hypodermis, h, nd, load(pull, at), load(inverse, at), law)
    return epidermis, dermis, hypodermis, block


@kernel(error_model="numpy", fastmath=True)
def sweep(
    columns: Columns, positions: Floats, loads: Floats, batches: Indices, count: int, longer: float, moved: Floats
) -> None:
    """One step of each of the first ``count`` of ``batches``, ``longer`` times Newton's; from the bone, Newton's.

    ``positions`` are moved in place; ``loads (B, 3, LANES)`` act on the hypodermis; ``moved (B,)`` gets the largest
    step of each batch in mm, squared.
    """
    law, zero, relax = columns.law, splat(ZERO), np.float32(longer)
    matrix, force = np.empty((_TRIANGLE, LANES), np.float32), np.empty((NODES, LANES), np.float32)
    for turn in range(count):
        batch = batches[turn]
        own = column(positions, batch)
        epidermis, dermis, hypodermis, block = surrounded(columns, batch, own, positions)
        e, d, h = (own[0], own[1], own[2]), (own[3], own[4], own[5]), (own[6], own[7], own[8])
        at = 2 * batch * LANES
        upper = joined(e, d, load(columns.own_pull, at), load(columns.own_inverse, at), law)
        lower = joined(d, h, load(columns.own_pull, at + LANES), load(columns.own_inverse, at + LANES), law)
        epidermis = plus(epidermis, upper, ONE)
        dermis = plus(plus(dermis, upper, -ONE), lower, ONE)
        hypodermis = plus(hypodermis, lower, -ONE)
        fx, fy, fz, along, across = held(columns, batch, columns.rest, h)
        normal = batch * _COMPONENTS * LANES
        nx, ny = load(columns.normal, normal), load(columns.normal, normal + LANES)
        nz = load(columns.normal, normal + 2 * LANES)
        hypodermis = pushed(hypodermis, nx, ny, nz, zero, across - along)
        hypodermis = plus(hypodermis, (fx, fy, fz, along, zero, along, zero, zero, along), ONE)
        put_block(matrix, 0, epidermis)
        put_block(matrix, 1, dermis)
        put_block(matrix, 2, hypodermis)
        put_between(matrix, 1, 0, upper)
        put_between(matrix, 2, 1, lower)
        put_crossing(matrix, block)
        for component in range(3):
            store(force, component * LANES, epidermis[component])
            store(force, (3 + component) * LANES, dermis[component])
            pull = load(loads, normal + component * LANES)
            store(force, (6 + component) * LANES, hypodermis[component] + pull)
        step(matrix, force)
        # a longer step from the bone would leave it, and the next one come back: what touches it takes Newton's
        touching = across - load(columns.tether, (2 * batch + 1) * LANES)
        length = choose(zero - touching, splat(relax), splat(ONE))
        at = batch * NODES * LANES
        most = zero
        for component in range(NODES):
            move = length * load(force, component * LANES)
            most = larger(most, move * move)
            store(positions, at + component * LANES, load(positions, at + component * LANES) + move)
        moved[batch] = largest(most)


@kernel(error_model="numpy", fastmath=True)
def shift(positions: Floats, rows: Floats, parts: Floats) -> None:
    """Adds ``parts (K,)`` of the ``rows (K, N)`` to the first N coordinates of ``positions``."""
    moved, every = positions.ravel(), rows.ravel()
    for first in range(0, rows.shape[1], _STRETCH):  # which stays in the nearest cache while all rows pass
        last = min(first + _STRETCH, rows.shape[1])
        for row in range(parts.shape[0]):
            part = splat(parts[row])
            if parts[row] != ZERO:
                start = row * rows.shape[1]
                for at in range(first, last, LANES):
                    store(moved, at, load(moved, at) + part * load(every, start + at))
