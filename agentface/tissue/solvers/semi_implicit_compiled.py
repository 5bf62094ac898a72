"""Steps of Eq. 12 and 13, and of the adaptive scheme's quasi-static nodes: one kernel, which takes long to compile."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.lanes import LANES
from agentface.deform.simd import load, store
from agentface.kernel import kernel
from agentface.tissue.columns import NODES, STATES, Columns
from agentface.tissue.forces_compiled import net_forces


@kernel(error_model="numpy", fastmath=True)
def move(
    columns: Columns,
    positions: Floats,
    velocities: Floats,
    ahead: Floats,
    loads: Floats,
    forces: Floats,
    first: int,
    last: int,
    quasi_static: bool,
    dt: float,
    mass: float,
    damping: float,
) -> None:
    """One time step of the batches ``first`` to ``last``, in place; ``ahead`` holds ``positions`` before and after.

    Dynamic nodes: forces are taken where the nodes will be (Eq. 13), in ``ahead``; then the velocities (Eq. 12, P of
    stretched springs in the denominator) and the positions follow. ``quasi_static`` ones go along their net forces, one
    batch after another by the newest places of the others, as far as their stiffness, that of springs and of the prisms
    at rest, asks for (section 5). ``mass`` is a node's, ``damping`` D; ``forces (B, 12, LANES)`` is scratch.
    """
    width = NODES * LANES
    step, heavy = np.float32(dt), np.float32(mass)
    slow = np.float32(mass + dt * damping)
    if not quasi_static:
        for at in range(first * width, last * width, LANES):
            store(ahead, at, load(positions, at) + step * load(velocities, at))
    start = first
    while start < last:
        end = start + 1 if quasi_static else last
        net_forces(columns, positions, ahead, loads, start, end, quasi_static, forces)
        for batch in range(start, end):
            for node in range(3):
                acting = (STATES * batch + 3 * node) * LANES
                stiff = load(forces, (STATES * batch + NODES + node) * LANES)
                if quasi_static:
                    stiff = stiff + load(columns.firmness, (3 * batch + node) * LANES)
                else:
                    stiff = slow + step * step * stiff
                for component in range(3):
                    at = batch * width + (3 * node + component) * LANES
                    go = load(forces, acting + component * LANES)
                    if not quasi_static:
                        go = step * go + heavy * load(velocities, at)
                    go = go / stiff
                    if not quasi_static:
                        store(velocities, at, go)
                        go = step * go
                    there = load(positions, at) + go
                    store(positions, at, there)
                    store(ahead, at, there)
        start = end
