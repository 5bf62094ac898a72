"""Steps of Eq. 12 and 13, and of the adaptive scheme's quasi-static nodes, compiled."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.lanes import LANES
from agentface.deform.simd import load, store
from agentface.kernel import kernel
from agentface.tissue.columns import NODES, Columns
from agentface.tissue.forces_compiled import column_forces
from agentface.tissue.springs_compiled import ONE, column


@kernel(error_model="numpy", fastmath=True)
def advance(
    columns: Columns,
    positions: Floats,
    velocities: Floats,
    ahead: Floats,
    loads: Floats,
    last: int,
    dt: float,
    mass: float,
    damping: float,
) -> None:
    """One time step of the first ``last`` batches, in place.

    Forces are taken where the nodes will be (Eq. 13), in ``ahead``, which holds ``positions`` before and after; then
    the velocities (Eq. 12, P of stretched springs in the denominator) and the positions follow. ``mass`` is a node's,
    ``damping`` D.
    """
    form, width = int(columns.law[5]), NODES * LANES
    step, heavy = np.float32(dt), np.float32(mass)
    slow = np.float32(mass + dt * damping)
    for at in range(0, last * width, LANES):
        store(ahead, at, load(positions, at) + step * load(velocities, at))
    for batch in range(last):
        own = column(positions, batch)
        states = column_forces(columns, batch, own, column(ahead, batch), ahead, loads, form, False)
        for node in range(3):
            state = states[node]
            over = ONE / (slow + step * step * state[3])
            at = batch * width + 3 * node * LANES
            for component in range(3):
                there = at + component * LANES
                store(velocities, there, (heavy * load(velocities, there) + step * state[component]) * over)
    for at in range(0, last * width, LANES):
        there = load(positions, at) + step * load(velocities, at)
        store(positions, at, there)
        store(ahead, at, there)


@kernel(error_model="numpy", fastmath=True)
def settle(columns: Columns, positions: Floats, loads: Floats, first: int, last: int) -> None:
    """Moves the nodes of the batches ``first`` to ``last`` along their net forces, by the newest places of the others.

    A node goes as far as its stiffness, that of its springs and of the prisms at rest, asks for (section 5).
    """
    form = int(columns.law[5])
    for batch in range(first, last):
        own = column(positions, batch)
        states = column_forces(columns, batch, own, own, positions, loads, form, True)
        for node in range(3):
            state = states[node]
            over = ONE / (state[3] + load(columns.firmness, (3 * batch + node) * LANES))
            at = (batch * NODES + 3 * node) * LANES
            for component in range(3):
                there = at + component * LANES
                store(positions, there, load(positions, there) + state[component] * over)
