"""The second paper's results: its semi-implicit and its adaptive scheme beside ours, five expressions, one run.

All are compiled with the same force kernels, in single precision, on one thread, each at its largest stable step.
"""

from __future__ import annotations

import time
from itertools import cycle
from statistics import median
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.studies.bench.timing import interleave, one_thread
from agentface.tissue import tables as tissue_tables
from agentface.tissue.columns import coloured, pack, unpacked
from agentface.tissue.lattice import build_lattice
from agentface.tissue.relaxation import relax
from agentface.tissue.solvers.adaptive import Adaptive
from agentface.tissue.solvers.block_descent import BlockDescent
from agentface.tissue.solvers.semi_implicit import SemiImplicit, stable_step
from agentface.tissue.tables import TissueTables

if TYPE_CHECKING:
    from agentface.head.model import HeadModel

EXPRESSIONS = ("happiness", "anger", "sadness", "disgust", "surprise")
"""The paper's, in the order of its Table 1."""
EQUAL_ERROR = 0.015
"""Of the largest displacement: the largest error of any node at which solvers are compared."""
FRAMES = 30
"""Of the ramp from rest to an expression, s-shaped in time."""
_RISE, _MOST = 60, 3000
"""Steps over which a load rises that the paper's schemes settle under, and steps at most."""


class Ramp(NamedTuple):
    """One expression: its contractions ``(23,)``, the equilibria of a ramp to it, its largest displacement in mm."""

    contractions: Doubles
    levels: Doubles
    equilibria: list[Doubles]
    largest_mm: float

    def error(self, tables: TissueTables, positions: Floats, frame: int = -1) -> Doubles:
        """``(3, V)``: how far each node is from equilibrium, in mm."""
        away = unpacked(tables.columns, positions) - self.equilibria[frame]
        return np.asarray(np.linalg.norm(away, axis=2))


def ramp(tables: TissueTables, expression: str) -> Ramp:
    """The ramp to an expression at full intensity, each frame's equilibrium as exact as single precision goes."""
    from agentface.emotion.inference import default_inference

    pose = default_inference().pose({expression: 1.0})
    whole = tables.drive.contractions(pose.array.astype(np.float64))
    part = np.arange(1, FRAMES + 1) / FRAMES
    levels = part * part * (3.0 - 2.0 * part)
    positions, found = tables.columns.rest.copy(), []
    for level in levels:
        loads = np.tensordot((level * whole).astype(np.float32), tables.loads, 1)
        relax(tables.columns, positions, loads, tolerance=3e-5)
        found.append(unpacked(tables.columns, positions))
    largest = float(np.linalg.norm(found[-1] - tables.lattice.rest, axis=2).max())
    return Ramp(whole, levels, found, largest)


def run(model: HeadModel | None = None, expressions: tuple[str, ...] = EXPRESSIONS) -> dict[str, Any]:
    """Times and errors by expression, as the paper's Table 1, Figure 7 and Figure 8 have them, and ours.

    ``nodes`` are those of the adaptive scheme's sets. ``iteration_ms`` is a time step of a scheme; ``precompute_s``
    what it needs before; ``saved_ratio`` the part of an iteration that the adaptive scheme saves, and
    ``saved_with_drawing_ratio`` the same as the paper counts, with ``draw_ms`` on both sides; its errors are those
    after its nodes have settled. ``to_equal_error_ms`` is how long it takes from rest, the load raised over 60 steps,
    until no node is farther off than 1.5 % of the largest displacement; None if that does not come. ``frame_ms`` is a
    frame of the ramp: of ``semi_implicit`` with as few steps as keep every frame within that error, of ``default`` as
    it is, with its ``worst_error_ratio``. ``semi_implicit_to_default_ratio`` is that of the two frames.
    """
    if model is None:
        from agentface.head.model import load_model

        model = load_model(asymmetry=0.0)
    tables = tissue_tables.of(model)
    _compile(tables)
    start = time.perf_counter()
    pack(build_lattice(model), coloured(tables.lattice, tables.mirror))
    built = time.perf_counter() - start
    draw_ms = _draw_ms(model)
    with one_thread():
        rows = {name: _expression(tables, name, built, draw_ms) for name in expressions}
    return {
        "vertices": len(model.vertices),
        "nodes": int(3 * tables.lattice.free.sum()),
        "springs": tables.lattice.spring_count,
        "draw_ms": draw_ms,
        "expressions": rows,
        "saved_with_drawing_mean_ratio": _mean(rows, "adaptive", "saved_with_drawing_ratio"),
        "semi_implicit_to_default_ratio": min(row["semi_implicit_to_default_ratio"] for row in rows.values()),
        "frame": _whole_frame(model),
    }


def _compile(tables: TissueTables) -> None:
    """Every kernel once, on a single muscle: compiling is nobody's time."""
    one = np.zeros(len(tables.loads))
    one[0] = 0.01
    for solver in (SemiImplicit(tables), Adaptive(tables), BlockDescent(tables)):
        solver.step(one, stable_step(tables))


def _expression(tables: TissueTables, name: str, built: float, draw_ms: float | None) -> dict[str, Any]:
    case = ramp(tables, name)
    adaptive, nodes = _adaptive(tables, case, built)
    times = _times(tables, case)
    whole, one = times["semi_implicit"], times["dynamic"] + times["quasi_static"]
    steps, error = _steps_a_frame(tables, case)
    drawn = draw_ms or 0.0
    adaptive |= {
        "dynamic_ms": times["dynamic"],
        "quasi_static_ms": times["quasi_static"],
        "iteration_ms": one,
        "to_equal_error_ms": _milliseconds(_to_equal_error(Adaptive(tables), tables, case), one),
        "saved_ratio": 1.0 - one / whole,
        "saved_with_drawing_ratio": 1.0 - (one + drawn) / (whole + drawn),
    }
    return {
        "largest_mm": case.largest_mm,
        "nodes": nodes,
        "semi_implicit": {
            "iteration_ms": whole,
            "precompute_s": built,
            "steps_a_frame": steps,
            "frame_ms": steps * whole,
            "worst_error_ratio": error,
            "to_equal_error_ms": _milliseconds(_to_equal_error(SemiImplicit(tables), tables, case), whole),
        },
        "adaptive": adaptive,
        "default": {"frame_ms": times["default"], **_default(tables, case)},
        "semi_implicit_to_default_ratio": steps * whole / times["default"],
    }


def _times(tables: TissueTables, case: Ramp) -> dict[str, float]:
    """Milliseconds, interleaved: a step of the semi-implicit scheme, the adaptive one's two parts, our frame."""
    dt, whole, own, adaptive = stable_step(tables), SemiImplicit(tables), BlockDescent(tables), Adaptive(tables)
    expression = adaptive.group(case.contractions)
    assert expression is not None, "an expression contracts muscles"  # noqa: S101 - for the type checker
    loads = np.tensordot(case.contractions.astype(np.float32), expression.loads, 1)
    levels = cycle([*case.levels, *case.levels[::-1]])
    tasks = {
        "semi_implicit": lambda: whole.iterate(case.contractions, dt),
        "dynamic": lambda: adaptive.move_dynamic(loads, dt),
        "quasi_static": lambda: adaptive.move_quasi_static(loads),
        "default": lambda: own.follow(next(levels) * case.contractions),
    }
    return {name: 1e-3 * time for name, time in interleave(tasks, 4 * FRAMES).items()}


def _default(tables: TissueTables, case: Ramp) -> dict[str, float]:
    solver, worst = BlockDescent(tables), 0.0
    for frame, level in enumerate(case.levels):
        solver.follow(level * case.contractions)
        worst = max(worst, float(case.error(tables, solver.positions, frame).max()))
    last = case.error(tables, solver.positions)
    return {
        "worst_error_ratio": worst / case.largest_mm,
        "error_max_mm": float(last.max()),
        "error_mean_mm": float(last.mean()),
    }


def _steps_a_frame(tables: TissueTables, case: Ramp) -> tuple[int, float]:
    """The fewest steps a frame, to a fiftieth, that keep all frames within ``EQUAL_ERROR``; and the worst error."""
    dt = stable_step(tables)

    def worst(steps: int) -> float:
        solver, largest = SemiImplicit(tables), 0.0
        for frame, level in enumerate(case.levels):
            for _ in range(steps):
                solver.iterate(level * case.contractions, dt)
            largest = max(largest, float(case.error(tables, solver.positions, frame).max()))
        return largest / case.largest_mm

    low, high = 0, 40
    while (error := worst(high)) > EQUAL_ERROR and high < _MOST:
        low, high = high, 2 * high
    while high - low > max(1, high // 50):
        middle = (low + high) // 2
        if (found := worst(middle)) <= EQUAL_ERROR:
            high, error = middle, found
        else:
            low = middle
    return high, error


def _to_equal_error(solver: SemiImplicit | Adaptive, tables: TissueTables, case: Ramp) -> int | None:
    """Steps from rest, the load raised over the first 60, until all nodes are within ``EQUAL_ERROR``; None: never."""
    dt = stable_step(tables)
    if isinstance(solver, Adaptive):
        solver.group(case.contractions)
    for done in range(1, _MOST + 1):
        solver.iterate(min(1.0, done / _RISE) * case.contractions, dt)
        if done % 10 == 0:
            if isinstance(solver, Adaptive):
                solver.show()
            if case.error(tables, solver.positions).max() <= EQUAL_ERROR * case.largest_mm:
                return done
    return None


def _milliseconds(steps: int | None, each: float) -> float | None:
    return None if steps is None else steps * each


def _adaptive(tables: TissueTables, case: Ramp, built: float) -> tuple[dict[str, Any], dict[str, int]]:
    """What it needs before, its errors when it has settled, and its nodes."""
    dt, solver, settled = stable_step(tables), Adaptive(tables), SemiImplicit(tables)
    start = time.perf_counter()
    for done in range(1, 8 * _RISE + 1):
        settled.iterate(min(1.0, done / _RISE) * case.contractions, dt)
    expression = solver.group(case.contractions)
    precompute = built + time.perf_counter() - start
    assert expression is not None, "an expression contracts muscles"  # noqa: S101 - for the type checker
    for done in range(1, 10 * _RISE + 1):
        solver.iterate(min(1.0, done / _RISE) * case.contractions, dt)
    solver.show()
    error = case.error(tables, solver.positions)
    return {
        "precompute_s": precompute,
        "error_max_mm": float(error.max()),
        "error_mean_mm": float(error.mean()),
        "error_max_ratio": float(error.max()) / case.largest_mm,
    }, expression.sets.nodes


def _draw_ms(model: HeadModel) -> float | None:
    """One picture of 640 by 480 in the fast quality; None where there is no OpenGL."""
    from agentface.deform.protocol import make_deformer
    from agentface.errors import GraphicsError
    from agentface.parameters import FacePose
    from agentface.view.renderer import Renderer

    try:
        with Renderer(model) as renderer:
            geometry, times = make_deformer("geometric", model).at(FacePose()), []
            for _ in range(6):
                start = time.perf_counter()
                renderer.render(geometry, (640, 480))
                times.append(1e3 * (time.perf_counter() - start))
    except GraphicsError:
        return None
    return median(times[1:])


def _whole_frame(model: HeadModel) -> dict[str, float]:
    """A whole frame of either deformer without drawing, in the same run."""
    from agentface.deform.protocol import make_deformer
    from agentface.studies.bench.frame import poses

    faces = poses()
    every, still = faces["all_active"], faces["smile"]
    solid, flat = make_deformer("tissue", model), make_deformer("geometric", model)
    moves = [every, still]

    def tissue() -> None:
        moves.reverse()
        solid.step(moves[0], 1 / 60)

    tissue()
    times = interleave({"tissue": tissue, "geometric": lambda: flat.step(every, 1 / 60)}, 60)
    return {
        "tissue_ms": 1e-3 * times["tissue"],
        "all_active_geometric_ms": 1e-3 * times["geometric"],
        "tissue_to_all_active_geometric_ratio": times["tissue"] / times["geometric"],
    }


def _mean(rows: dict[str, Any], part: str, key: str) -> float:
    return float(np.mean([row[part][key] for row in rows.values()]))
