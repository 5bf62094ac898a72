"""FAPU: the distances of the neutral face in which FAPs are counted (ISO/IEC 14496-2, Annex C)."""

from __future__ import annotations

from typing import NamedTuple

from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.mpeg4.fap_table import FapUnit
from agentface.mpeg4.feature_points import feature_points

PARTS = 1024
"""Units a distance."""
_NEEDED = ("2.2", "3.1", "3.3", "3.5", "3.6", "8.3", "8.4", "9.15")


class Fapu(NamedTuple):
    """The size of a unit: metres, and radians for AU."""

    IRISD: float
    """Between the lids, 3.1.y - 3.3.y, which stands for the iris's diameter."""
    ES: float
    """Between the pupils, 3.5.x - 3.6.x."""
    ENS: float
    """Between eyes and nose, 3.5.y - 9.15.y."""
    MNS: float
    """Between mouth and nose, 9.15.y - 2.2.y."""
    MW: float
    """Of the mouth's width, 8.3.x - 8.4.x."""
    AU: float = 1e-5

    def of(self, unit: FapUnit) -> float:
        """The size of a unit by its name; 1 for none."""
        return 1.0 if unit == "none" else float(getattr(self, unit))


def fapu(model: HeadModel) -> Fapu:
    """The units of a face; heights are the means of both sides, which are not quite alike.

    Raises InvalidValueError where it lacks one of the points, or its points lie so that a distance is none.
    """
    points = feature_points(model)
    missing = [number for number in _NEEDED if number not in points]
    if missing:
        raise InvalidValueError(f"feature points of {model.name}", "those that the units need", ", ".join(missing))
    x, y = ({number: float(points[number].position[axis]) for number in points} for axis in (0, 1))
    eyes = 0.5 * (y["3.5"] + y["3.6"])
    lids = y["3.1"] - y["3.3"] if "3.2" not in y else 0.5 * (y["3.1"] - y["3.3"] + y["3.2"] - y["3.4"])
    distances = lids, x["3.5"] - x["3.6"], eyes - y["9.15"], y["9.15"] - y["2.2"], x["8.3"] - x["8.4"]
    if min(distances) <= 0.0:
        raise InvalidValueError(f"feature points of {model.name}", "a neutral face's distances, above 0", distances)
    return Fapu(*(distance / PARTS for distance in distances))
