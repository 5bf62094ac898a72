"""The net forces on columns, compiled; the numpy twin is :func:`agentface.tissue.forces.forces`."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats
from agentface.deform.lanes import LANES
from agentface.deform.simd import choose, inverse_root, larger, load, splat, store
from agentface.kernel import kernel
from agentface.tissue.columns import AROUND, NODES, STATES, Columns
from agentface.tissue.springs_compiled import ONE, ZERO, column, neighbours, pressed, prism, tension
from agentface.tissue.tissue_file import FORMS

_PRINTED, _SIGNED, _EPIDERMIS = (FORMS.index(form) for form in ("printed", "signed", "epidermis"))
_SPRINGS, _COMPONENTS = len(AROUND), 3
_TINY = np.float32(1e-20)


@kernel(error_model="numpy", inline="always", fastmath=True)
def drawn(state: Any, node: Any, ahead: Any, other: Any, pull: Any, inverse: Any, law: Any, whole: Any) -> Any:
    """A node's force and stiffness with one spring more (Eq. 12): P by where it will be, the pull by where it is.

    The stiffness is the sum of P of stretched springs, or, if ``whole``, of all slopes of tensions.
    """
    x, y, z = ahead[0] - other[0], ahead[1] - other[1], ahead[2] - other[2]
    side, slope, _ = tension(x * x + y * y + z * z, pull, inverse, law)
    return (
        state[0] - side * (node[0] - other[0]),
        state[1] - side * (node[1] - other[1]),
        state[2] - side * (node[2] - other[2]),
        state[3] + (slope if whole else larger(side, splat(ZERO))),
    )


@kernel(error_model="numpy", inline="always", fastmath=True)
def held(columns: Any, batch: Any, at: Any, node: Any) -> Any:
    """The bone's force on hypodermis nodes, and its stiffness along and across the skin."""
    rest = (batch * NODES + 6) * LANES
    x, y, z = node[0] - load(at, rest), node[1] - load(at, rest + LANES), node[2] - load(at, rest + 2 * LANES)
    normal = batch * _COMPONENTS * LANES
    nx, ny, nz = (
        load(columns.normal, normal),
        load(columns.normal, normal + LANES),
        load(columns.normal, normal + 2 * LANES),
    )
    along, across = load(columns.tether, 2 * batch * LANES), load(columns.tether, (2 * batch + 1) * LANES)
    out = x * nx + y * ny + z * nz
    deep = splat(ZERO) - load(columns.gap, batch * LANES) - out
    touch = choose(deep, splat(columns.law[4]), splat(ZERO))
    pull = touch * deep - (across - along) * out
    return pull * nx - along * x, pull * ny - along * y, pull * nz - along * z, along, across + touch


@kernel(error_model="numpy", inline="always", fastmath=True)
def squeezed(columns: Any, own: Any, one: Any, other: Any, row: Any, form: Any) -> Any:
    """(6,): what the prism between two neighbours does to the upper and to the lower node."""
    volume, slopes = prism(own, one, other)
    inverse = load(columns.volume, row * LANES)
    zero = splat(ZERO)
    rho = choose(zero - inverse, zero, splat(columns.law[3]))
    relative = volume * inverse
    if form == _PRINTED or form == _SIGNED:  # noqa: SIM109  # numba would make a tuple
        change = relative - ONE
        size = change * change * rho
        if form == _SIGNED:
            size = choose(change, zero - size, size)
        ax, ay, az = one[0] - own[0], one[1] - own[1], one[2] - own[2]
        bx, by, bz = other[0] - own[0], other[1] - own[1], other[2] - own[2]
        nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        size = size * inverse_root(nx * nx + ny * ny + nz * nz + _TINY)
        upper, lower = (size * nx, size * ny, size * nz), (zero, zero, zero)
    else:
        push = zero - rho * pressed(relative)[0]
        upper = (push * slopes[0], push * slopes[1], push * slopes[2])
        if form == _EPIDERMIS:
            push = zero
        lower = (push * slopes[3], push * slopes[4], push * slopes[5])
    return upper[0], upper[1], upper[2], lower[0], lower[1], lower[2]


@kernel(error_model="numpy", inline="always", fastmath=True)
def _states(columns: Any, batch: Any, own: Any, ahead: Any, positions: Any, loads: Any, form: Any, whole: Any) -> Any:
    """Three states (force, stiffness) of a batch whose nodes are at ``own`` and will be at ``ahead``."""
    law = columns.law
    load_at = batch * _COMPONENTS * LANES
    zero = splat(ZERO)
    e, d, h = (own[0], own[1], own[2]), (own[3], own[4], own[5]), (own[6], own[7], own[8])
    ea, da, ha = (ahead[0], ahead[1], ahead[2]), (ahead[3], ahead[4], ahead[5]), (ahead[6], ahead[7], ahead[8])
    bone = held(columns, batch, columns.rest, ha)
    steady = column(columns.steady, batch)
    epidermis, dermis = (steady[0], steady[1], steady[2], zero), (steady[3], steady[4], steady[5], zero)
    hypodermis = (
        load(loads, load_at) + bone[0] + steady[6],
        load(loads, load_at + LANES) + bone[1] + steady[7],
        load(loads, load_at + 2 * LANES) + bone[2] + steady[8],
        bone[4],
    )
    first, last = columns.first[batch], columns.first[batch + 1]
    before = neighbours(positions, columns.neighbour, last - 1)
    for row in range(first, last):
        there = neighbours(positions, columns.neighbour, row)
        wedge = squeezed(columns, ahead, before, there, last - 1 if row == first else row - 1, form)
        epidermis = (epidermis[0] + wedge[0], epidermis[1] + wedge[1], epidermis[2] + wedge[2], epidermis[3])
        hypodermis = (hypodermis[0] + wedge[3], hypodermis[1] + wedge[4], hypodermis[2] + wedge[5], hypodermis[3])
        before = there
        ne, nd, nh = (there[0], there[1], there[2]), (there[3], there[4], there[5]), (there[6], there[7], there[8])
        at, pull, inverse = row * _SPRINGS * LANES, columns.pull, columns.inverse
        epidermis = drawn(epidermis, e, ea, ne, load(pull, at), load(inverse, at), law, whole)
        at += LANES
        dermis = drawn(dermis, d, da, nd, load(pull, at), load(inverse, at), law, whole)
        at += LANES
        hypodermis = drawn(hypodermis, h, ha, nh, load(pull, at), load(inverse, at), law, whole)
        at += LANES
        epidermis = drawn(epidermis, e, ea, nd, load(pull, at), load(inverse, at), law, whole)
        at += LANES
        dermis = drawn(dermis, d, da, ne, load(pull, at), load(inverse, at), law, whole)
        at += LANES
        dermis = drawn(dermis, d, da, nh, load(pull, at), load(inverse, at), law, whole)
        at += LANES
        hypodermis = drawn(hypodermis, h, ha, nd, load(pull, at), load(inverse, at), law, whole)
    at = 2 * batch * LANES
    upper, upper_inverse = load(columns.own_pull, at), load(columns.own_inverse, at)
    lower, lower_inverse = load(columns.own_pull, at + LANES), load(columns.own_inverse, at + LANES)
    epidermis = drawn(epidermis, e, ea, da, upper, upper_inverse, law, whole)
    dermis = drawn(
        drawn(dermis, d, da, ea, upper, upper_inverse, law, whole), d, da, ha, lower, lower_inverse, law, whole
    )
    hypodermis = drawn(hypodermis, h, ha, da, lower, lower_inverse, law, whole)
    return epidermis, dermis, hypodermis


@kernel(error_model="numpy", fastmath=True)
def net_forces(
    columns: Columns, positions: Floats, ahead: Floats, loads: Floats, first: int, last: int, whole: bool, out: Floats
) -> None:
    """Writes the net forces on the batches ``first`` to ``last``, and their nodes' stiffness, to ``out``.

    ``out`` is ``(B, 12, LANES)``. Nodes are at ``positions`` and will be ``ahead``, as will be their neighbours;
    both are the same for forces at rest. ``loads (B, 3, LANES)`` are the muscles' on the hypodermis. A stiffness is
    the sum of P of stretched springs, or, if ``whole``, of all slopes of tensions.
    """
    form = int(columns.law[5])
    for batch in range(first, last):
        states = _states(columns, batch, column(positions, batch), column(ahead, batch), ahead, loads, form, whole)
        at = batch * STATES * LANES
        for node in range(3):
            state = states[node]
            for component in range(3):
                store(out, at + (3 * node + component) * LANES, state[component])
            store(out, at + (NODES + node) * LANES, state[3])
