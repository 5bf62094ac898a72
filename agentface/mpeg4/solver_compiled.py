"""The solver, compiled: the numpy twin's own code with the compiled look, and its sums without BLAS and its threads."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles
from agentface.kernel import compiled_twin, kernel
from agentface.mpeg4 import solver
from agentface.mpeg4.sight_compiled import look  # noqa: F401
from agentface.mpeg4.solver import (  # noqa: F401
    DAMP,
    EASE,
    FIRM,
    FLAT,
    NEAR,
    ROUNDS,
    SHARE,
    SHORT,
    SMALL,
    STILL,
    SWEEPS,
)


@kernel(fastmath=True, error_model="numpy")
def gram(rows: Doubles) -> Doubles:
    """``rows' rows``, of rows that are mostly 0."""
    count = rows.shape[1]
    out = np.zeros((count, count))
    at = np.empty(count, np.int64)
    for row in rows:
        used = 0
        for i in range(count):
            if row[i] != 0.0:
                at[used] = i
                used += 1
        for i in range(used):
            for j in range(i + 1):
                out[at[i], at[j]] += row[at[i]] * row[at[j]]
    for i in range(count):
        for j in range(i):
            out[j, i] = out[i, j]
    return out


@kernel(fastmath=True, error_model="numpy")
def accumulate(out: Doubles, by: float, row: Doubles) -> None:
    """Add ``by`` times ``row`` to ``out``."""
    for i in range(out.shape[0]):
        out[i] += by * row[i]


@kernel(fastmath=True, error_model="numpy")
def settle(a: Doubles, right: Doubles) -> None:
    """Turn ``right`` into the solution of a x = right, by Cholesky's factors in the place of ``a``."""
    count = right.shape[0]
    for i in range(count):
        for j in range(i + 1):
            total = a[i, j]
            for k in range(j):
                total -= a[i, k] * a[j, k]
            a[i, j] = math.sqrt(total) if i == j else total / a[j, j]
    for i in range(count):
        for k in range(i):
            right[i] -= a[i, k] * right[k]
        right[i] /= a[i, i]
    for i in range(count - 1, -1, -1):
        right[i] /= a[i, i]
        for k in range(i):
            right[k] -= a[i, k] * right[i]


whole_step = compiled_twin(solver.whole_step, globals(), error_model="numpy")
box_minimum = compiled_twin(solver.box_minimum, globals(), error_model="numpy", fastmath=True)
learn = compiled_twin(solver.learn, globals(), error_model="numpy", fastmath=True)
next_step = compiled_twin(solver.next_step, globals(), error_model="numpy")
solve = compiled_twin(solver.solve, globals(), error_model="numpy")
