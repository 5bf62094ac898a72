"""FAPs measured and solved: what a frame costs, and how near the round trip comes, FAP by FAP."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import lsq_linear

from agentface.conventions import Doubles, Floats
from agentface.deform.crowd import Crowd
from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.head.model import load_model
from agentface.mpeg4.fap_solver import FapSolution, FapSolver
from agentface.mpeg4.natural import natural_poses, uniform_poses
from agentface.resources import DEFAULT_FACE
from agentface.studies.bench.timing import interleave, one_thread

POSES = 500
_BATCH = 1_000
_FRAMES = 12
"""Frames of a stream from one pose to the next."""
_ROUNDS = 5
_NO_RANGE = 10.0
_ALONE = 20
"""Poses that scipy solves: it takes its time."""


def run(
    face: str | Path = DEFAULT_FACE, deformer_name: str = DEFAULT_DEFORMER, poses: int = POSES, batch: int = _BATCH
) -> dict[str, Any]:
    """Microseconds a frame, and errors in percent of each FAP's range.

    The range of a FAP is its largest less its least value over 500 poses with every parameter anywhere in its range,
    seed 0: the poses of ``uniform``. ``natural`` are emotions mixed with visemes, lids, gaze and head. Both are
    solved each on its own; ``stream`` walks from one natural pose to the next, each frame from the one before.
    Errors are of what a whole face of ``deformer_name`` shows in the poses found, against what it shows in the poses
    asked for; solving is always for the geometric face. ``measure_us`` is of ``batch`` faces in one call.
    ``lsq_linear_us`` is scipy's solution of one linear step on the same matrix in the same box, without any look at the
    face; ours, ``solve_*_us``, are all steps with their looks.
    """
    model = load_model(face)
    solver = FapSolver(model)
    crowd = Crowd(model, deformer=deformer_name)

    def shown(values: Floats) -> Floats:
        return solver.meter.measure(crowd.deform(values))

    made = {
        "uniform": uniform_poses(poses, np.random.default_rng(0)),
        "natural": natural_poses(poses, np.random.default_rng(0)),
    }
    asked = {kind: shown(values).copy() for kind, values in made.items()}
    ranges = np.ptp(asked["uniform"], axis=0)
    with one_thread() as limited:
        report: dict[str, Any] = {"one_thread": limited, "faps_with_a_range": int((ranges > _NO_RANGE).sum())}
        report |= _times(solver, crowd, made, asked, batch)
        for kind, targets in asked.items():
            found = np.stack([solver.solve(target).pose.array for target in targets])
            report[kind] = errors(shown(found), targets, ranges)
        walk = stream(made["natural"][: max(2, poses // _FRAMES)])
        targets = shown(walk).copy()
        report["stream"] = errors(shown(_followed(solver, targets)), targets, ranges)
    crowd.close()
    return report


def errors(shown: Floats, asked: Floats, ranges: Floats) -> dict[str, Any]:
    """Mean and worst of the mean errors of each FAP that has a range, in percent of it, and each FAP's by number."""
    moving = ranges > _NO_RANGE
    each = 100.0 * np.abs(shown - asked)[:, moving].mean(axis=0) / ranges[moving]
    numbers = np.flatnonzero(moving) + 1
    return {
        "mean_percent": float(each.mean()),
        "worst_percent": float(each.max()),
        "worst_fap": int(numbers[each.argmax()]),
        "faps_percent": {str(number): float(error) for number, error in zip(numbers, each, strict=True)},
    }


def stream(poses: Floats, frames: int = _FRAMES) -> Floats:
    """``(F, COUNT)``: straight from each pose to the next in ``frames`` frames."""
    way = np.linspace(0.0, 1.0, frames, endpoint=False, dtype=np.float32)[:, None]
    return np.concatenate([one + way * (other - one) for one, other in pairwise(poses)])


def _followed(solver: FapSolver, targets: Floats) -> Floats:
    found: FapSolution | None = None
    followed = np.empty((len(targets), len(solver.solve(targets[0]).pose.array)), np.float32)
    for row, target in zip(followed, targets, strict=True):
        found = solver.solve(target, previous=found)
        row[:] = found.pose.array
    return followed


def _times(
    solver: FapSolver, crowd: Crowd, made: dict[str, Floats], asked: dict[str, Floats], batch: int
) -> dict[str, Any]:
    many = crowd.deform(np.resize(made["natural"], (batch, made["natural"].shape[1])))
    one = crowd.deform(made["natural"][:1])[0].copy()
    some = {kind: targets[:_ALONE] for kind, targets in asked.items()}
    walk = solver.meter.measure(crowd.deform(stream(made["natural"][:3]))).copy()

    def each(targets: Floats) -> Callable[[], None]:
        def solve() -> None:
            for target in targets:
                solver.solve(target)

        return solve

    def scipy() -> None:
        for target in some["natural"]:
            _solved_by_scipy(solver, target)

    tasks: dict[str, Callable[[], Any]] = {
        "measure": lambda: solver.meter.measure(many),
        "measure_one": lambda: solver.meter.measure(one),
        "frame": lambda: crowd.deform(made["natural"][:_ALONE]),
        **{kind: each(targets) for kind, targets in some.items()},
        "stream": lambda: _followed(solver, walk),
        "scipy": scipy,
    }
    times = interleave(tasks, _ROUNDS)
    return {
        "measure_us": times["measure"] / batch,
        "measure_one_us": times["measure_one"],
        "deform_us": times["frame"] / _ALONE,
        "solve_uniform_us": times["uniform"] / len(some["uniform"]),
        "solve_natural_us": times["natural"] / len(some["natural"]),
        "solve_stream_us": times["stream"] / len(walk),
        "lsq_linear_us": times["scipy"] / len(some["natural"]),
    }


def _solved_by_scipy(solver: FapSolver, target: Floats) -> npt.NDArray[np.float64]:
    """The parameters that one linear step finds from rest."""
    fit = solver.fit
    count = len(fit.problem.free)
    goal: Doubles = np.append(target[solver.meter.columns] / np.maximum(fit.ranges, _NO_RANGE), [0.0, 0.0])
    rows = np.vstack([fit.problem.jacobian, np.sqrt(1e-3) * np.eye(count)])
    found = lsq_linear(rows, np.append(goal, np.zeros(count)), (fit.problem.low, fit.problem.high), tol=1e-4)
    return np.asarray(found.x)
