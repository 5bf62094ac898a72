"""What a pose would show, compiled; the numpy twin is :mod:`agentface.mpeg4.sight`.

A look is a frame without what no feature tells: creases beside lids and lips, midpoints, and all of the finish but the
turn of the jaw.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform import order_compiled, tables
from agentface.deform.finish.order import FinishStage
from agentface.deform.geometry import FaceArrays, FaceGeometry
from agentface.deform.order import Stage
from agentface.deform.order_compiled import Scratch, finish, shape
from agentface.deform.tables import FaceTables
from agentface.head.model import HeadModel
from agentface.kernel import kernel
from agentface.mpeg4.readings import Kind, Readings
from agentface.mpeg4.readings_compiled import read
from agentface.mpeg4.sight import Features

_LAST = int(Stage.CONTACT)
_JAW = int(FinishStage.TEETH)


class Sight(NamedTuple):
    """Everything that a look needs: the face's tables, one face to write on, and the features."""

    tables: FaceTables
    scratch: Scratch
    face: FaceArrays
    seen: Indices
    """``(S,)`` vertices that are read."""
    readings: Readings
    matrix: Doubles
    """``(N, C)``."""
    numbers: Doubles
    """``(C,)``, the readings of the last look."""


def new_sight(model: HeadModel, features: Features) -> Sight:
    """A sight of its own scratch: one look at a time."""
    shared = tables.of(model)
    readings = features.readings
    seen = np.unique(readings.vertex[readings.kind != Kind.BONE]).astype(np.int32)
    face = FaceGeometry.at_rest(model).arrays()
    matrix = np.ascontiguousarray(features.matrix, np.float64)
    return Sight(shared, order_compiled.new_scratch(shared), face, seen, readings, matrix, np.zeros(len(readings.kind)))


@kernel(error_model="numpy")
def look(sight: Sight, values: Floats, out: Doubles) -> None:
    """Write the features of the pose ``values (COUNT,)`` into ``out (N,)``."""
    shape(sight.tables, sight.scratch, _LAST, values)
    face, points = sight.face, sight.scratch.points
    for vertex in sight.seen:
        for axis in range(3):
            face.vertices[vertex, axis] = points[vertex, axis]
    finish(_JAW, _JAW, sight.tables.finish, values, face)
    read(sight.readings, face, sight.numbers)
    np.dot(sight.matrix, sight.numbers, out)
