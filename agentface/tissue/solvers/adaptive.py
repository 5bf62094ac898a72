"""The paper's adaptive simulation (Zhang, Prakash and Sung, section 5): three sets of nodes, each moved its own way.

Sets are of whole columns: a vertex of the skin and the two nodes under it.
"""

from __future__ import annotations

from collections import deque
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.mesh.graph import Mask
from agentface.tissue.columns import Columns, coloured, new_forces, pack, packed, rings_of, unpacked
from agentface.tissue.lattice import Lattice
from agentface.tissue.relaxation import new_loads
from agentface.tissue.solvers.equilibrium import equilibrium
from agentface.tissue.solvers.semi_implicit import divided
from agentface.tissue.tables import TissueTables

THRESHOLD = 0.01
"""Of the largest displacement: what moves less in the whole simulation is static."""


class NodeSets(NamedTuple):
    """The columns of one expression, as vertices of the skin.

    Attributes:
        dynamic: those that a muscle pulls on.
        quasi_static: the others that move, in breadth-first order from the dynamic ones.
        distance: ``(V,)`` springs from the nearest dynamic column; -1 where there is none, or no way.
        static: how many columns of the mesh are neither.
    """

    dynamic: Indices
    quasi_static: Indices
    distance: Indices
    static: int

    @property
    def nodes(self) -> dict[str, int]:
        """How many nodes each set has: three a column."""
        sets = {"dynamic": len(self.dynamic), "quasi_static": len(self.quasi_static), "static": self.static}
        return {name: 3 * count for name, count in sets.items()}


def node_sets(lattice: Lattice, forces: Doubles, moved: Doubles, threshold: float = THRESHOLD) -> NodeSets:
    """The sets for muscles that pull with ``forces (V, 3)`` on an equilibrium that has ``moved (3, V, 3)`` mm."""
    far = np.linalg.norm(moved, axis=2).max(axis=0)
    dynamic = lattice.free & forces.any(axis=1)
    moves = lattice.free & ~dynamic & (far >= threshold * far.max())
    distance = breadth_first(rings_of(lattice), dynamic, lattice.free)
    chosen = np.flatnonzero(moves)
    order = chosen[np.argsort(distance[chosen], kind="stable")]
    static = len(dynamic) - int(dynamic.sum()) - len(order)
    return NodeSets(np.flatnonzero(dynamic).astype(np.int32), order.astype(np.int32), distance, static)


def breadth_first(rings: list[list[int]], start: Mask, passable: Mask) -> Indices:
    """``(V,)``: edges from the nearest vertex of ``start``, by ``passable`` ones alone; -1 where none leads there."""
    distance = np.where(start, 0, -1).astype(np.int32)
    queue = deque(np.flatnonzero(start).tolist())
    while queue:
        vertex = queue.popleft()
        for other in rings[vertex]:
            if distance[other] < 0 and passable[other]:
                distance[other] = distance[vertex] + 1
                queue.append(other)
    return distance


class Expression(NamedTuple):
    """One expression's sets, and its columns batched by them.

    Attributes:
        sets: the nodes.
        columns: batches of dynamic columns first, then of quasi-static ones, from the nearest to the farthest.
        dynamic: how many batches are dynamic.
        loads: ``(23, B, 3, LANES)`` of the muscles.
    """

    sets: NodeSets
    columns: Columns
    dynamic: int
    loads: Floats


def prepare(tables: TissueTables, contractions: Doubles) -> Expression:
    """Groups the nodes of the expression of ``contractions (23,)``."""
    lattice = tables.lattice
    acting = np.tensordot(contractions, tables.forces, 1)
    moved = unpacked(tables.columns, equilibrium(tables, contractions)) - lattice.rest
    sets = node_sets(lattice, acting, moved)
    levels, rings = sets.distance[sets.quasi_static], rings_of(lattice)
    groups = [sets.dynamic]
    for level in np.unique(levels).tolist():
        groups += coloured(lattice, tables.mirror, sets.quasi_static[levels == level], rings)
    columns = pack(lattice, groups)
    return Expression(sets, columns, int(columns.colours[1]), new_loads(columns, tables.forces))


class Adaptive:
    """Dynamic nodes by semi-implicit integration, quasi-static ones along their residual forces, static ones not.

    The sets are those of the muscles that contract; when others do, they are found anew, which takes seconds.
    """

    def __init__(self, tables: TissueTables) -> None:
        self._tables = tables
        self.positions: Floats = tables.columns.rest.copy()
        self._contractions = np.zeros(len(tables.loads))
        self._known: dict[bytes, Expression] = {}
        self._expression: Expression | None = None
        self._own: Floats = self.positions
        self._velocities: Floats = np.zeros_like(self.positions)
        self._ahead: Floats = self.positions
        self._forces = new_forces(tables.columns)

    def reset(self, contractions: Doubles) -> None:
        """Stand still in the equilibrium of ``contractions (23,)``."""
        self.positions[:] = equilibrium(self._tables, contractions)
        self._contractions = contractions.copy()
        self._expression = None

    def step(self, contractions: Doubles, dt: float) -> None:
        """Go on by ``dt`` s, in as many equal steps as stability asks for."""
        self.group(np.maximum(contractions, self._contractions))
        if self._expression is None:
            return
        for there, part in divided(self._tables, self._contractions, contractions, dt):
            self.iterate(there, part)
        self._contractions = contractions.copy()
        self.show()

    def group(self, contractions: Doubles) -> Expression | None:
        """Take the sets for the muscles that ``contractions`` has; none where none acts and none has."""
        acting = np.packbits(contractions > 0.0).tobytes()
        if not contractions.any():
            return self._expression
        if acting not in self._known:
            self._known[acting] = prepare(self._tables, contractions)
        chosen = self._known[acting]
        if chosen is not self._expression:
            before = self._tables.columns if self._expression is None else self._expression.columns
            still = np.zeros_like(self.positions)
            there = self.positions if self._expression is None else self._own
            speeds = still if self._expression is None else self._velocities
            self._own = moved_to(before, chosen.columns, there, padding=-1.0)
            self._velocities = moved_to(before, chosen.columns, speeds)
            self._ahead, self._forces = self._own.copy(), new_forces(chosen.columns)
            self._expression = chosen
        return chosen

    def iterate(self, contractions: Doubles, dt: float) -> None:
        """One step of ``dt`` s of the grouped expression; :meth:`show` then says where that leads."""
        if self._expression is not None:
            loads = np.tensordot(contractions.astype(np.float32), self._expression.loads, 1)
            self.move_dynamic(loads, dt)
            self.move_quasi_static(loads)

    def move_dynamic(self, loads: Floats, dt: float) -> None:
        """The first part of a step: the dynamic nodes."""
        if self._expression is not None:
            self._move(self._expression, loads, (0, self._expression.dynamic), dt)

    def move_quasi_static(self, loads: Floats) -> None:
        """The second part: the quasi-static nodes, from the nearest to the farthest."""
        if self._expression is not None:
            last = len(self._expression.columns.first) - 1
            self._move(self._expression, loads, (self._expression.dynamic, last))

    def _move(self, expression: Expression, loads: Floats, some: tuple[int, int], dt: float | None = None) -> None:
        """Moves the batches from one to another: dynamic ones by a time step, quasi-static ones without."""
        from agentface.tissue.solvers.semi_implicit_compiled import move

        state = (self._own, self._velocities, self._ahead, loads, self._forces)
        mass, drag = self._tables.mass, self._tables.drag
        move(expression.columns, *state, *some, dt is None, dt or 0.0, mass, drag)

    def show(self) -> None:
        """Brings :attr:`positions` up to date."""
        if self._expression is not None:
            self.positions[:] = moved_to(self._expression.columns, self._tables.columns, self._own)


def moved_to(before: Columns, after: Columns, state: Floats, padding: float = 0.0) -> Floats:
    """Positions or speeds of the same lattice, batched in another way."""
    return packed(after.vertex, unpacked(before, state), padding)
