"""Bulges and wrinkles: heights of the skin by the contraction of the muscles (Bui et al., section 4).

Every train's height at full contraction is known at rest, by the vertices' original position; a frame scales it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.head.model import HeadModel
from agentface.head.trains import heights as rest_heights

_LOWEST = 1e-6  # m, what is not worth a store


class WrinkleTables(NamedTuple):
    """The K trains of a face.

    Attributes:
        parameters: int32 ``(K, M)``, the indices of the parameters that raise each train, the first one repeated.
        first: int32 ``(K + 1,)``, where each train's entries begin.
        vertices: int32 ``(N,)``, the vertices that a train raises.
        heights: float32 ``(N,)`` m, how far at full contraction.
        raised: int32, every vertex of ``vertices`` once.
    """

    parameters: Indices
    first: Indices
    vertices: Indices
    heights: Floats
    raised: Indices


def prepare(model: HeadModel) -> WrinkleTables:
    """The heights of a face's trains by the original position of its vertices."""
    most = max((len(placed.parameters) for placed in model.trains), default=1)
    rows = [(*placed.parameters, *placed.parameters[:1] * most)[:most] for placed in model.trains]
    first, vertices, heights = [0], [], []
    for placed in model.trains:
        reached = np.flatnonzero(placed.reach)
        height = placed.reach[reached] * rest_heights(placed.train, model.vertices[reached])
        raised = height > _LOWEST
        vertices.append(reached[raised])
        heights.append(height[raised])
        first.append(first[-1] + int(raised.sum()))
    everywhere = np.concatenate([*vertices, np.zeros(0)]).astype(np.int32)
    return WrinkleTables(
        np.array(rows, np.int32).reshape(-1, most),
        np.array(first, np.int32),
        everywhere,
        np.concatenate([*heights, np.zeros(0)]).astype(np.float32),
        np.unique(everywhere),
    )


def levels(tables: WrinkleTables, values: Floats, out: Floats) -> None:
    """Writes to ``out`` float32 ``(K,)`` the contraction of each train: of its muscles, the most contracted one's."""
    np.clip(values[tables.parameters].max(axis=1), 0.0, 1.0, out=out)


def heights(tables: WrinkleTables, values: Floats, out: Floats) -> None:
    """Writes to ``out`` float32 ``(V,)`` m: at each vertex the highest of the trains, ``max_k c_k h_k(v)``."""
    level = np.zeros(len(tables.parameters), np.float32)
    levels(tables, values, level)
    out[:] = 0.0
    np.maximum.at(out, tables.vertices, np.repeat(level, np.diff(tables.first)) * tables.heights)


def raise_vertices(tables: WrinkleTables, heights: Floats, normals: Floats, vertices: Floats) -> None:
    """Moves ``vertices (V, 3)`` in place along unit ``normals (V, 3)`` of the displaced skin by ``heights (V,)`` m."""
    raised = tables.raised
    vertices[raised] += heights[raised, None] * normals[raised]
