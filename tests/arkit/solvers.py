"""Solvers of the faces that ship, shared: nothing may write to their arrays."""

from __future__ import annotations

from functools import cache

from agentface.arkit.shape_solver import ShapeSolver
from agentface.head.model import load_model
from agentface.studies.bench.arkit import shapes_shown


@cache
def solver_of(face: str) -> ShapeSolver:
    return ShapeSolver(load_model(face))


@cache
def rows_of(face: str) -> dict[str, dict[str, float]]:
    return shapes_shown(solver_of(face))
