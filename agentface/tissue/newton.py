"""The equilibrium by Newton's method on the whole tissue, in double precision and numpy: seconds a step, and exact.

It is what stands in where nothing can be compiled, and what the others are held against.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Doubles
from agentface.tissue.forces import energy, forces, stiffness
from agentface.tissue.lattice import Lattice
from agentface.tissue.layers import HYPODERMIS

_STEPS, _HALVINGS, _ENOUGH = 40, 12, 1e-4
_SPLU = {"permc_spec": "MMD_AT_PLUS_A", "diag_pivot_thresh": 0.0, "options": {"SymmetricMode": True}}


def factors(lattice: Lattice, points: Doubles) -> Any:
    """The factors of the stiffness with the nodes at ``points (3 V, 3)``; scipy's, with ``solve``."""
    from scipy.sparse.linalg import splu

    return splu(stiffness(lattice, points), **_SPLU)


def solve(lattice: Lattice, factored: Any, load: Doubles) -> Doubles:
    """``(3 V, 3)`` mm: where ``load (3 V, 3)`` moves the nodes, by a linear stiffness."""
    nodes, moved = np.flatnonzero(np.tile(lattice.free, 3)), np.zeros_like(load)
    moved[nodes] = factored.solve(load[nodes].ravel()).reshape(-1, 3)
    return moved


def newton(lattice: Lattice, pull: Doubles, points: Doubles | None = None) -> Doubles:
    """``(3, V, 3)`` mm: the equilibrium under ``pull (V, 3)`` on the hypodermis, found from ``points`` or from rest.

    A step that would raise the energy is halved.
    """
    here = lattice.points if points is None else points.reshape(-1, 3)
    load = np.zeros_like(lattice.rest)
    load[HYPODERMIS] = pull
    load = load.reshape(-1, 3)
    now = energy(lattice, here, load)
    for _ in range(_STEPS):
        step = solve(lattice, factors(lattice, here), forces(lattice, here, load))
        part = 1.0
        for _ in range(_HALVINGS):
            there = here + part * step
            then = energy(lattice, there, load)
            if then <= now + 1e-9 * abs(now):
                break
            part *= 0.5
        here, now = there, then
        if part * np.abs(step).max() < _ENOUGH:
            break
    return here.reshape(lattice.rest.shape)
