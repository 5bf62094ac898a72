"""The 84 feature points of MPEG-4 on a face at rest (ISO/IEC 14496-2, Annex C)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Floats
from agentface.deform.finish import head_turn
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.feature_points import FEATURE_POINTS
from agentface.head.model import HeadModel


@dataclass(frozen=True, slots=True, eq=False)
class FeaturePoint:
    """A feature point of a face.

    Attributes:
        number: such as ``8.3``.
        mesh: ``skin``, a part's name, or nothing where the point is no vertex.
        vertex: its vertex there; -1 where it is none.
        position: ``(3,)`` float32 m at rest.
    """

    number: str
    mesh: str
    vertex: int
    position: Floats


def feature_points(model: HeadModel) -> dict[str, FeaturePoint]:
    """The points that a face has, by number: all but those that its file says are absent."""
    points: dict[str, FeaturePoint] = {}
    for number in FEATURE_POINTS:
        row = model.feature_points[number]
        if row.vertex is not None:
            mesh = model.vertices if row.mesh == "skin" else model.parts[row.mesh].attributes["POSITION"]
            points[number] = FeaturePoint(number, row.mesh, row.vertex, np.asarray(mesh[row.vertex], np.float32))
        elif row.place is not None:
            place = head_turn.prepare(model).neck if row.place == "neck" else model.landmarks[row.place]
            points[number] = FeaturePoint(number, "", -1, np.asarray(place, np.float32))
    return points


def absent_points(model: HeadModel) -> dict[str, str]:
    """The points that a face has not, and why."""
    return {number: row.absent for number, row in model.feature_points.items() if row.absent is not None}


def feature_point(model: HeadModel, number: str) -> FeaturePoint:
    """One of them; raises UnknownNameError, and InvalidValueError for one that the face has not."""
    if number not in FEATURE_POINTS:
        raise UnknownNameError("feature point", number, FEATURE_POINTS)
    found = feature_points(model).get(number)
    if found is None:
        reason = model.feature_points[number].absent
        raise InvalidValueError(f"feature point {number}", f"a point that {model.name} has", "none", str(reason))
    return found
