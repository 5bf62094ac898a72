"""The artists' shapes of a head as features of its skin: what some of the vertices do, on a basis of few numbers."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Indices
from agentface.head.arkit import ARKIT_SHAPES
from agentface.head.model import HeadModel
from agentface.mpeg4.readings import Kind, Readings

SKIN_SHAPES: tuple[str, ...] = tuple(
    name for name in ARKIT_SHAPES if not name.startswith("eyeLook") and name != "tongueOut"
)
"""Those that are solved for. The eyes' turns and the tongue are given by themselves, and the lids follow the eyes."""
SKIN_PLACES: Indices = np.array([ARKIT_SHAPES.index(name) for name in SKIN_SHAPES], np.int32)
_MM = 1e3
_SAMPLED = 600
_MOVED_MM = 0.5
_KEPT = 1e-2
"""Of the largest singular value of the movements, what is not worth a feature."""


class SampledShapes(NamedTuple):
    """V of a face's vertices that shapes move, and its S skin shapes there.

    Attributes:
        readings: of 3 V numbers in mm.
        ways: ``(S, 3 V)`` mm, what each shape does there.
        scale: what makes the sum of squares over V vertices that over all that are moved.
    """

    readings: Readings
    ways: Doubles
    scale: float


def sample_shapes(model: HeadModel) -> SampledShapes:
    """The shapes at vertices drawn with seed 0, each with its image; a shape that the head has not moves nothing."""
    count = len(model.vertices)
    dense = np.zeros((len(SKIN_SHAPES), count, 3))
    for row, name in zip(dense, SKIN_SHAPES, strict=True):
        if name in model.shapes:
            row[:] = _MM * model.shapes[name].dense(count)
    moved = np.flatnonzero(np.linalg.norm(dense, axis=2).max(axis=0) > _MOVED_MM)
    left = moved[model.vertices[moved, 0] >= 0.0]
    drawn = np.random.default_rng(0).choice(left, min(_SAMPLED // 2, len(left)), replace=False)
    vertices = np.unique(np.concatenate([drawn, model.mirror[drawn]])).astype(np.int32)
    vertex, axis = np.repeat(vertices, 3), np.tile(np.arange(3, dtype=np.int32), len(vertices))
    kind, scale = np.full(len(vertex), Kind.SKIN, np.int32), np.full(len(vertex), _MM)
    rest = model.vertices[vertex, axis].astype(np.float64)
    readings = Readings(kind, vertex, axis, scale, rest, np.zeros((1, 3)), np.zeros(3, np.int32))
    share = float(np.sqrt(len(moved) / max(len(vertices), 1)))
    return SampledShapes(readings, dense[:, vertices].reshape(len(dense), -1), share)


def basis_of(shapes: SampledShapes, movements: Doubles) -> Doubles:
    """``(K, 3 V)``: orthogonal rows, times the scale, that span the shapes and what else the face does there.

    ``movements`` is ``(M, 3 V)`` mm.
    """
    _, sizes, rows = np.linalg.svd(np.vstack([shapes.ways, movements]), full_matrices=False)
    return np.ascontiguousarray(shapes.scale * rows[sizes > _KEPT * sizes.max(initial=0.0)])
