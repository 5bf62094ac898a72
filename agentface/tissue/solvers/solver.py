"""What every solver keeps to, and the list of them by name."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from typing import Protocol

from agentface.conventions import Doubles, Floats
from agentface.errors import UnknownNameError
from agentface.tissue.tables import TissueTables


class Solver(Protocol):
    """Moves the tissue of one face; each holds its own positions."""

    positions: Floats
    """``(batches, 9, LANES)`` mm of the columns of :attr:`agentface.tissue.tables.TissueTables.columns`."""

    def reset(self, contractions: Doubles) -> None:
        """Stand still with the muscles ``(23,)`` contracted, whatever came before."""

    def step(self, contractions: Doubles, dt: float) -> None:
        """Go on by ``dt`` s in which the contractions went straight to these."""


DEFAULT_SOLVER = "block_descent"
_SOLVERS = {
    DEFAULT_SOLVER: "agentface.tissue.solvers.block_descent:BlockDescent",
    "semi_implicit": "agentface.tissue.solvers.semi_implicit:SemiImplicit",
    "adaptive": "agentface.tissue.solvers.adaptive:Adaptive",
}


def solver_names() -> tuple[str, ...]:
    """The names of the solvers."""
    return tuple(_SOLVERS)


def make_solver(name: str, tables: TissueTables, *, compiled: bool = True) -> Solver:
    """The solver ``name`` for the tissue of a face; raises UnknownNameError.

    The paper's two are compiled or not at all: without compiled kernels the default stands in for them.
    """
    if name not in _SOLVERS:
        raise UnknownNameError("solver", name, solver_names())
    if not compiled:
        from agentface.tissue.solvers.block_descent import BlockDescent

        return BlockDescent(tables, compiled=False)
    module, _, attribute = _SOLVERS[name].partition(":")
    factory: Callable[[TissueTables], Solver] = getattr(import_module(module), attribute)
    return factory(tables)
