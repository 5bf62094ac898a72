"""How muscles that move the same vertex combine: three ways, chosen by name.

Each way is a schedule: the order in which parts of the contractions act. The parts of one step act at the same
positions and are summed; the next step starts from the moved vertices. ``parallel``, ``sequential`` and ``summed``
are written in numpy as the papers say; :class:`Combiner` hands a schedule to a compiled kernel.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any, Literal, TypeAlias

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats, check_vertices
from agentface.deform.muscles.vector_muscle import NOTHING, pull
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.muscle_set import MuscleSet

Method: TypeAlias = Literal["parallel", "sequential", "summed"]
METHODS: tuple[Method, ...] = ("parallel", "sequential", "summed")
STEP = 0.2
"""The unit of contraction of ``parallel``, delta_c (Bui, Heylen, Nijholt, section 3.1)."""

Points: TypeAlias = npt.NDArray[np.floating[Any]]
_NOBODY: Floats = np.zeros((0, 0), np.float32)


def parallel(rest: Points, muscles: MuscleSet, contractions: Points) -> Doubles:
    """Bui, Heylen, Nijholt: every muscle contracts by at most 0.2, all displacements are summed, then again.

    Args:
        rest: ``(V, 3)`` m.
        muscles: the muscles.
        contractions: ``(M,)`` in 0..1.

    Returns:
        float64 ``(V, 3)`` m, the moved vertices.
    """
    *_, moved = parallel_way(rest, muscles, contractions)
    return moved


def parallel_way(rest: Points, muscles: MuscleSet, contractions: Points) -> Iterator[Doubles]:
    """The vertices before each step of :func:`parallel`, and after the last."""
    moved = np.asarray(rest, dtype=np.float64)
    left = np.asarray(contractions, dtype=np.float64)
    yield moved
    while (left > NOTHING).any():
        part = np.minimum(left, STEP)
        moved = summed(moved, muscles, part)
        left = left - part
        yield moved


def sequential(rest: Points, muscles: MuscleSet, contractions: Points) -> Doubles:
    """Waters: one muscle after another in the set's order, each at its full contraction, on moved vertices."""
    moved = np.array(rest, dtype=np.float64)
    for muscle in np.flatnonzero(contractions):
        moved += pull(muscles, int(muscle), moved, float(contractions[muscle]))
    return moved


def summed(rest: Points, muscles: MuscleSet, contractions: Points) -> Doubles:
    """Wang: the displacements of all muscles at the rest position, summed."""
    start = np.asarray(rest, dtype=np.float64)
    moved = start.copy()
    for muscle in np.flatnonzero(contractions):
        moved += pull(muscles, int(muscle), start, float(contractions[muscle]))
    return moved


REFERENCE = {"parallel": parallel, "sequential": sequential, "summed": summed}
"""The numpy forms by name, in double precision."""


class Combiner:
    """The moved vertices of one face for any contractions, by a compiled kernel.

    Args:
        rest_vertices: float32 ``(V, 3)`` m.
        muscles: muscles whose ``reach`` has V columns.
        method: ``"parallel"``, ``"sequential"`` or ``"summed"``.
        compiled: False for the numpy form, which starts at once and takes a hundred times as long a frame.

    Attributes:
        steps: S, how many steps the schedule has.

    Raises:
        InvalidValueError: when the vertices are not finite or do not match the muscles.
        UnknownNameError: for another method.
    """

    def __init__(
        self, rest_vertices: Points, muscles: MuscleSet, method: Method = "parallel", *, compiled: bool = True
    ) -> None:
        rest = check_vertices("rest_vertices", rest_vertices)
        if len(rest) != muscles.vertex_count:
            raise InvalidValueError("rest_vertices", f"the muscles' {muscles.vertex_count} vertices", len(rest))
        if method not in METHODS:
            raise UnknownNameError("way to combine muscles", method, METHODS)
        self.muscles = muscles
        self.method = method
        self.steps: int = {"parallel": math.ceil(1.0 / STEP), "sequential": len(muscles), "summed": 1}[method]
        self._rest = rest
        self._compiled = compiled
        if not compiled:
            return
        from agentface.deform.muscles import blocks, combine_compiled

        self._blocks = blocks.pack(rest, muscles)
        self._step = STEP if method == "parallel" else math.inf
        self._parts = np.zeros((self.steps, len(muscles)), dtype=np.float32)
        self._levels = np.zeros(len(muscles), dtype=np.float64)
        self._kernels = combine_compiled

    def apply(self, contractions: Points, out: Floats, shares: Floats = _NOBODY, found: Floats = _NOBODY) -> None:
        """Writes the moved vertices to ``out``; where no muscle acts they are the rest vertices, bit for bit.

        Muscles of another kind may contract in the same steps: they want to know where each of their parts finds the
        vertices that are theirs, the last K.

        Args:
            contractions: ``(M,)`` in 0..1.
            out: float32 ``(V, 3)`` in C order, m.
            shares: float32 ``(S + 1, J)``, which part of each of J others acts in each step, and which after the last;
                they sum to 1.
            found: float32 ``(K, J)`` m, written: the x at which they find these vertices, the mean over their parts.

        Raises:
            InvalidValueError: for a wrong shape or a contraction outside 0..1, NaN included; ``out`` is untouched.
        """
        if out.shape != self._rest.shape or out.dtype != np.float32 or not out.flags.c_contiguous:
            expected = f"float32 {self._rest.shape} in C order"
            raise InvalidValueError("out", expected, f"{out.dtype} {out.shape}")
        if contractions.shape != (len(self.muscles),):
            raise InvalidValueError("contractions", f"shape {(len(self.muscles),)}", contractions.shape)
        if not self._compiled:
            self._apply_reference(np.asarray(contractions, dtype=np.float64), out, shares, found)
            return
        schedule = self._kernels.spread if self.method == "sequential" else self._kernels.slice_steps
        self._levels[:] = contractions
        bad = schedule(self._levels, self._step, self._parts)
        if bad >= 0:
            raise self._refusal(bad, contractions)
        self._kernels.contract(self._rest, self._blocks, self._parts, shares, found, out)

    def _apply_reference(self, contractions: Doubles, out: Floats, shares: Floats, found: Floats) -> None:
        bad = np.flatnonzero(~((contractions >= 0.0) & (contractions <= 1.0)))
        if len(bad):
            raise self._refusal(int(bad[0]), contractions)
        if self.method == "parallel":
            way = list(parallel_way(self._rest, self.muscles, contractions))
        else:
            way = [REFERENCE[self.method](self._rest, self.muscles, contractions)]
        out[:] = way[-1]
        first = len(out) - len(found)
        found[:] = 0.0
        for step, share in enumerate(shares):
            found += share * way[min(step, len(way) - 1)][first:, :1]

    def _refusal(self, muscle: int, contractions: Points) -> InvalidValueError:
        name = self.muscles.names[muscle]
        return InvalidValueError(f"contraction of {name}", "a number in 0..1", float(contractions[muscle]))
