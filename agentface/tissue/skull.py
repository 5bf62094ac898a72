"""The bone under a face: fitted to the depth of its soft tissue, then nudged by hand as the paper's user does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel
from agentface.mesh.graph import SparseMatrix, smoothed
from agentface.tissue.tissue_file import SkullTable

_ROUNDS = 4


@dataclass(frozen=True, eq=False)
class Skull:
    """The bone: a point under each vertex of the skin, with the skin's triangles.

    Attributes:
        points: ``(V, 3)`` mm, with the jaw closed.
        fitted: the same before it was nudged.
        jaw_weights: ``(V,)`` 0..1, how far each point belongs to the jaw.
    """

    points: Doubles
    fitted: Doubles
    jaw_weights: Floats


def fit_skull(model: HeadModel, bone: Doubles, beside: SparseMatrix, table: SkullTable) -> Skull:
    """The skull through ``bone (V, 3)`` mm, the ends of the depths, evened out; then moved by ``table``."""
    fitted = smoothed(beside, bone, _ROUNDS)
    return Skull(moved(fitted, table), fitted, model.jaw_weights)


def moved(points: Doubles, table: SkullTable) -> Doubles:
    """Rotated about x, then y, then z, and scaled, about the points' middle; then translated."""
    middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
    turn = np.eye(3)
    for axis, angle in enumerate(np.radians(table.rotate_deg)):
        one, other = (axis + 1) % 3, (axis + 2) % 3
        step = np.eye(3)
        step[one, one] = step[other, other] = np.cos(angle)
        step[other, one], step[one, other] = np.sin(angle), -np.sin(angle)
        turn = step @ turn
    return np.asarray((points - middle) * table.scale @ turn.T + middle + table.translate_mm)
