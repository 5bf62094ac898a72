"""The vertices that a finer mesh has between those of the lips' and the lids' rings: they stay in the middle.

Lips, contact and lid margins are told by rings; :mod:`agentface.head.resample` puts new vertices between these.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.head.model import HeadModel
from agentface.head.resample import ResampledModel

_HALF = np.float32(0.5)


class MidpointTables(NamedTuple):
    """``rows (N, 3)`` int32: a vertex and the two that it lies between; rows whose vertices others need come first."""

    rows: Indices


def prepare(model: HeadModel) -> MidpointTables:
    """The tables of a face; no rows where it is as it was read."""
    rows = model.between if isinstance(model, ResampledModel) else np.zeros((0, 3), np.int32)
    return MidpointTables(np.ascontiguousarray(rows, np.int32))


def apply(tables: MidpointTables, points: Floats) -> None:
    """Put each vertex of ``points (P, 3)`` m in the middle of its two: p = (a + b) / 2."""
    for vertex, one, other in tables.rows.tolist():
        points[vertex] = _HALF * (points[one] + points[other])
