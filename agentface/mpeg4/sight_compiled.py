"""What a pose would show, compiled; the numpy twin is :mod:`agentface.mpeg4.sight`.

A look is a frame without what no feature tells: creases beside lids and lips, midpoints, all of the finish but eyes,
jaw and tongue, and of the tongue all vertices that are not read.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform import order_compiled, tables
from agentface.deform.finish.order import FinishStage
from agentface.deform.geometry import FaceArrays, FaceGeometry
from agentface.deform.order import Stage
from agentface.deform.order_compiled import Scratch, finish, shape
from agentface.deform.tables import FaceTables
from agentface.deform.tongue.tables import TongueTables, only
from agentface.head.model import HeadModel
from agentface.kernel import kernel
from agentface.mpeg4.readings import Kind, Readings
from agentface.mpeg4.readings_compiled import read
from agentface.mpeg4.sight import Features

_LAST = int(Stage.CONTACT)
_EYES, _TONGUE = int(FinishStage.EYES), int(FinishStage.TONGUE)


class Sight(NamedTuple):
    """Everything that a look needs: the face's tables, one face to write on, and the features."""

    tables: FaceTables
    scratch: Scratch
    face: FaceArrays
    readings: Readings
    matrix: Doubles
    """``(N, C)``."""
    numbers: Doubles
    """``(C,)``, the readings of the last look."""


def new_sight(model: HeadModel, features: Features) -> Sight:
    """A sight of its own scratch: one look at a time."""
    whole = tables.of(model)
    tongue, readings = _read_of_tongue(whole.finish.tongue, features.readings)
    shared = whole._replace(finish=whole.finish._replace(tongue=tongue))
    face = FaceGeometry.at_rest(model).arrays()._replace(tongue=tongue.rest.copy())
    matrix = np.ascontiguousarray(features.matrix, np.float64)
    return Sight(shared, order_compiled.new_scratch(shared), face, readings, matrix, np.zeros(len(readings.kind)))


def _read_of_tongue(tongue: TongueTables, readings: Readings) -> tuple[TongueTables, Readings]:
    """A tongue of the vertices that are read, which move without each other, and the readings of these."""
    places = readings.kind == Kind.TONGUE
    used, rows = np.unique(np.append(readings.vertex[places], readings.roll), return_inverse=True)
    vertex = readings.vertex.copy()
    vertex[places] = rows[: places.sum()]
    roll = rows[places.sum() :].astype(readings.roll.dtype)
    return only(tongue, used), readings._replace(vertex=vertex, roll=roll)


@kernel(error_model="numpy")
def look(sight: Sight, values: Floats, out: Doubles) -> None:
    """Write the features of the pose ``values (COUNT,)`` into ``out (N,)``."""
    shape(sight.tables, sight.scratch, _LAST, values)
    face, points = sight.face, sight.scratch.points
    moved, shown = points.ravel(), face.vertices.ravel()
    for place in range(shown.shape[0]):
        shown[place] = moved[place]
    finish(_EYES, _TONGUE, sight.tables.finish, values, face)
    read(sight.readings, face, sight.numbers)
    np.dot(sight.matrix, sight.numbers, out)
