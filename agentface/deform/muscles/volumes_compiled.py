"""The volumes' loop, single precision; the numpy twin is :mod:`agentface.deform.muscles.volumes`."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.deform.muscles.volumes import VolumeTables
from agentface.kernel import kernel

_ZERO, _ONE = np.float32(0.0), np.float32(1.0)


@kernel(error_model="numpy")
def apply(tables: VolumeTables, values: Floats, points: Floats) -> None:
    """Move ``points (P, 3)`` m in place, to the parameters ``values``."""
    for volume in range(tables.parameters.shape[0]):
        level = _ZERO
        for muscle in range(tables.parameters.shape[1]):
            level += values[tables.parameters[volume, muscle]] * tables.shares[volume, muscle]
        if level > _ZERO:
            level = min(level, _ONE)
            for entry in range(tables.first[volume], tables.first[volume + 1]):
                vertex = tables.vertices[entry]
                points[vertex, 0] += level * tables.ways[entry, 0]
                points[vertex, 1] += level * tables.ways[entry, 1]
                points[vertex, 2] += level * tables.ways[entry, 2]
