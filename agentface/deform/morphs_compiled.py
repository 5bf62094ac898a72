"""The morphs' loop, single precision; the numpy twin is :mod:`agentface.deform.morphs`."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Floats
from agentface.deform import morphs
from agentface.deform.morphs import LIP_HALVES, MorphTables
from agentface.kernel import kernel

jaw_slide = kernel(error_model="numpy")(morphs.jaw_slide)
_share_of_lip = kernel(error_model="numpy")(morphs.share_of_lip)
_ZERO, _ONE = np.float32(0.0), np.float32(1.0)


@kernel(error_model="numpy")
def apply(tables: MorphTables, values: Floats, points: Floats) -> None:
    """Move ``points (P, 3)`` m in place, to the parameters ``values``."""
    used = np.zeros(LIP_HALVES + 1, np.float32)  # the last is of what belongs to no lip
    left = max(_ZERO, _ONE - values[tables.whole[0]] - values[tables.whole[1]])
    for morph in range(tables.parameters.shape[0]):
        used[tables.lips[morph]] += max(_ZERO, tables.signs[morph] * values[tables.parameters[morph]])
    angle = np.float32(tables.widest * values[tables.jaw])
    for morph in range(tables.parameters.shape[0]):
        level = tables.signs[morph] * values[tables.parameters[morph]]
        if level <= _ZERO:
            continue
        if tables.lips[morph] >= 0:
            level *= _share_of_lip(left, used[tables.lips[morph]])
        for entry in range(tables.first[morph], tables.first[morph + 1]):
            vertex = tables.vertices[entry]
            up, ahead = level * tables.ways[entry, 1], level * tables.ways[entry, 2]
            points[vertex, 0] += level * tables.ways[entry, 0]
            turn = angle * tables.shares[entry]
            if turn == _ZERO:
                points[vertex, 1] += up
                points[vertex, 2] += ahead
            else:
                cosine, sine = np.float32(math.cos(turn)), np.float32(math.sin(turn))
                points[vertex, 1] += cosine * up - sine * ahead
                points[vertex, 2] += sine * up + cosine * ahead
