"""ARKit's 52 shapes of a face, baked: what its own muscles make of each, on the skin and on all that moves with it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import numpy as np

from agentface.arkit.shape_solver import ShapeSolver
from agentface.conventions import Doubles
from agentface.deform.geometry import FaceGeometry
from agentface.deform.protocol import Deformer
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.model import HeadModel
from agentface.io.gltf.face_parts import released
from agentface.io.gltf.surface import Surface, apart_mm, less
from agentface.io.gltf.writer import Target
from agentface.mpeg4.looking import Looking

_WITH_JAW = {"mouthClose": 1.0, "tongueOut": 0.5}
"""Shapes that are seen only while the jaw is open: baked as the change that they make there, at this ``jawOpen``."""
_RIDGE = 1e-4
Shapes = dict[str, dict[str, Target]]
"""By the name of the shape, by part."""


def bake_arkit(
    model: HeadModel, deformer: Deformer, surface: Surface, told: Callable[[float], object] = lambda _: None
) -> tuple[Shapes, Doubles]:
    """The 52 shapes, and ``(52, 3 N)`` m what they do to the surface; ``told`` gets the number that are done.

    Poses are sought by the solver of ARKit's weights, so that a weight does here what it does in the engine.
    """
    solver = ShapeSolver(model)

    def shown(weights: Mapping[str, float]) -> FaceGeometry:
        return released(model, deformer.at(solver.solve_named(weights).pose))

    shapes: Shapes = {}
    rows = np.zeros((len(ARKIT_SHAPES), surface.size))
    for number, name in enumerate(ARKIT_SHAPES):
        opened = _WITH_JAW.get(name)
        if opened is None:
            there = shown({name: 1.0})
            shapes[name], rows[number] = surface.targets(there), surface.row(there)
        else:
            there, jaw = shown({name: 1.0, "jawOpen": opened}), shown({"jawOpen": opened})
            shapes[name], rows[number] = _between(surface, jaw, there), surface.row(there) - surface.row(jaw)
        told(number + 1)
    return shapes, rows


def _between(surface: Surface, first: FaceGeometry, second: FaceGeometry) -> dict[str, Target]:
    before, after = surface.targets(first), surface.targets(second)
    found = {}
    for name in before | after:
        some = after.get(name) or before[name]
        still = Target(np.zeros_like(some.places), None if some.normals is None else np.zeros_like(some.normals))
        found[name] = less(after.get(name, still), before.get(name, still))
    return found


class ShapeWeights:
    """Finds the weights 0..1 of shapes whose sum is nearest to a movement, by least squares.

    Args:
        rows: ``(S, 3 N)`` m, what each of S shapes does.
    """

    def __init__(self, rows: Doubles) -> None:
        self._rows, self._looking = rows, Looking()
        square = rows @ rows.T
        self._square = square + _RIDGE * np.trace(square) / len(square) * np.eye(len(square))
        self._found = np.zeros(len(rows))
        self._low, self._high = np.zeros(len(rows)), np.ones(len(rows))
        self.weights: list[Doubles] = []
        self._errors: list[tuple[float, float]] = []

    def add(self, row: Doubles) -> None:
        """One frame's movement ``(3 N,)`` m; the search begins at the weights of the frame before."""
        self._looking.box_minimum(self._square, self._rows @ row, self._low, self._high, self._found)
        self.weights.append(self._found.copy())
        off = apart_mm(row - self._found @ self._rows)
        self._errors.append((float(off.max()), float((off**2).mean())))

    @property
    def error_max_mm(self) -> float:
        """How far the farthest vertex of all frames is off."""
        return max(largest for largest, _ in self._errors)

    @property
    def error_rms_mm(self) -> float:
        """The root of the mean square of all vertices' distances."""
        return float(np.sqrt(np.mean([square for _, square in self._errors])))
