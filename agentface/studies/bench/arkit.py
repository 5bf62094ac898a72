"""ARKit's weights: what a frame costs, what muscles make of each of the artists' shapes, and how weights come back."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from scipy.optimize import lsq_linear

from agentface.arkit.sampled_shapes import SKIN_PLACES, SKIN_SHAPES
from agentface.arkit.shape_solver import ArkitSolution, ShapeSolver
from agentface.conventions import Doubles, Floats
from agentface.deform.protocol import DEFAULT_DEFORMER
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.model import load_model
from agentface.resources import DEFAULT_FACE
from agentface.studies.bench.timing import interleave, one_thread

MADE = 0.8
"""The cosine from which on the muscles can make a shape."""
MIXTURES = 100
_OF = 5
_FRAMES = 12
"""Frames of a stream from one mixture to the next."""
_ROUNDS = 5
_RIDGE = 1e-2
"""mm, how strongly weights of 0 hold when they are sought on the artists' shapes."""


def run(
    face: str | Path = DEFAULT_FACE, deformer_name: str = DEFAULT_DEFORMER, mixtures: int = MIXTURES
) -> dict[str, Any]:
    """Microseconds a frame, and errors of weights; solving is for the geometric face, whatever the deformer is called.

    ``shapes`` has for each of the skin's shapes, alone at 1, what :func:`shapes_shown` says. ``mixtures`` are of five
    of the shapes that the muscles can make, seed 1: the mean error of the five weights, and of all weights that could
    have been there; ``on_shapes`` are those of weights sought on the artists' shapes instead of on the face's answers.
    """
    solver = ShapeSolver(load_model(face))
    rows = shapes_shown(solver)
    drawn, chosen = mixed(made(rows), mixtures)
    with one_thread() as limited:
        return {
            "one_thread": limited,
            "deformer": deformer_name,
            "features": len(solver.fit.features.matrix),
            **_times(solver, drawn[:_FRAMES]),
            "shapes_made": len(made(rows)),
            "mixtures": errors(solver, drawn, chosen, made(rows)),
            "shapes": rows,
        }


def shapes_shown(solver: ShapeSolver) -> dict[str, dict[str, float]]:
    """For each of the skin's shapes, alone at 1 (mouthClose with jawOpen): ``residual`` and ``cosine`` of what shows.

    ``residual`` is a part of the shape's own movement; ``back`` the weight that the pose gives back, and
    ``back_on_shapes`` the one sought on the artists' shapes.
    """
    rows = {}
    jaw = solver.solve_named(dict.fromkeys(ARKIT_SHAPES, 0.0) | {"jawOpen": 1.0}).features
    for name, shape in zip(SKIN_SHAPES, solver.fit.shapes, strict=True):
        asked = dict.fromkeys(ARKIT_SHAPES, 0.0) | {name: 1.0}
        closes = name == "mouthClose"
        found = solver.solve_named(asked | {"jawOpen": 1.0} if closes else asked)
        shown = found.features - jaw if closes else found.features
        size, moved = float(np.linalg.norm(shape)), float(np.linalg.norm(shown))
        rows[name] = {
            "residual": float(np.linalg.norm(shape - shown)) / size,
            "cosine": float(shape @ shown) / (size * max(moved, 1e-9)),
            "back": float(solver.weights(found.pose.array)[ARKIT_SHAPES.index(name)]),
            "back_on_shapes": float(on_shapes(solver, found)[SKIN_SHAPES.index(name)]),
        }
    return rows


def made(rows: dict[str, dict[str, float]]) -> list[int]:
    """The places among ``SKIN_SHAPES`` of those that the muscles can make; mouthClose is none by itself."""
    names = [name for name, row in rows.items() if row["cosine"] >= MADE and name != "mouthClose"]
    return [SKIN_SHAPES.index(name) for name in names]


def mixed(places: list[int], count: int) -> tuple[Floats, list[list[int]]]:
    """``(count, 52)`` weights with five anywhere in 0..1, seed 1, and which five of the skin's shapes they are."""
    draw = np.random.default_rng(1)
    weights, chosen = np.zeros((count, len(ARKIT_SHAPES)), np.float32), []
    for row in weights:
        five = draw.choice(places, _OF, replace=False)
        row[SKIN_PLACES[five]] = draw.random(_OF)
        chosen.append(five.tolist())
    return weights, chosen


def errors(solver: ShapeSolver, drawn: Floats, chosen: list[list[int]], places: list[int]) -> dict[str, Any]:
    """Mean errors of the weights that come back of the poses found for ``drawn``."""
    means: dict[str, list[float]] = {}
    each: dict[str, list[float]] = {}
    for weights, five in zip(drawn, chosen, strict=True):
        found = solver.solve(weights)
        miss = np.abs(solver.weights(found.pose.array) - weights)[SKIN_PLACES]
        other = np.abs(on_shapes(solver, found) - weights[SKIN_PLACES])
        for of, which in (("five", five), ("all", places)):
            means.setdefault(f"error_of_{of}", []).append(float(miss[which].mean()))
            means.setdefault(f"on_shapes_error_of_{of}", []).append(float(other[which].mean()))
        for place in five:
            each.setdefault(SKIN_SHAPES[place], []).append(float(miss[place]))
    return {
        **{name: float(np.mean(found)) for name, found in means.items()},
        "each": {name: float(np.mean(found)) for name, found in sorted(each.items())},
    }


def on_shapes(solver: ShapeSolver, found: ArkitSolution) -> Doubles:
    """``(S,)``: weights by least squares on the artists' shapes themselves, as scipy finds them."""
    shapes = solver.fit.shapes
    size = _RIDGE * np.sqrt(np.mean(shapes * shapes) * shapes.shape[1])
    rows = np.vstack([shapes.T, size * np.eye(len(shapes))])
    weights: Doubles = lsq_linear(rows, np.append(found.features, np.zeros(len(shapes))), (0.0, 1.0)).x
    return weights


def _times(solver: ShapeSolver, drawn: Floats) -> dict[str, float]:
    way = np.linspace(0.0, 1.0, _FRAMES, dtype=np.float32)[:, None]
    walk = drawn[0] + way * (drawn[1] - drawn[0])
    poses = [solver.solve(weights).pose.array for weights in drawn]

    def cold() -> None:
        for weights in drawn:
            solver.solve(weights)

    def stream() -> None:
        found: ArkitSolution | None = None
        for weights in walk:
            found = solver.solve(weights, previous=found)

    def back() -> None:
        for pose in poses:
            solver.weights(pose)

    times = interleave({"cold": cold, "stream": stream, "back": back}, _ROUNDS)
    return {
        "solve_us": times["cold"] / len(drawn),
        "solve_stream_us": times["stream"] / len(walk),
        "weights_us": times["back"] / len(poses),
    }
