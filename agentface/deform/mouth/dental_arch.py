"""The front of a row of teeth and its gum as an upright parabolic cylinder."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TypeVar

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel

_EDGE_MARGIN, _FADE = 0.0004, 0.003  # m
_WIDER = 1.1  # how much wider than the mouth is the part of the arch that counts
_SLICES, _FRONT_SLICES = 14, 10  # so wide that each has of a tooth's front
_FRONT_TEETH, _INCISORS, _NEAR_EDGE = 0.013, 0.006, 0.0016  # m: from the middle, and from the edges
_Places = TypeVar("_Places", Floats, Doubles)


@dataclass(frozen=True, slots=True)
class Arch:
    """The surface z = front - bend x^2.

    Attributes:
        front: m.
        bend: 1/m.
        edge: m, the height of the teeth's free edges.
        fade: m, over which they count less beyond their edges; negative for teeth that end upward.
    """

    front: float
    bend: float
    edge: float
    fade: float

    @property
    def numbers(self) -> list[float]:
        """The row of :class:`agentface.deform.mouth.contact_tables.ContactTables.arch`."""
        return [self.front, self.bend, self.edge, self.fade]

    def distance(self, points: Doubles) -> Doubles:
        """``(K,)`` m: how far each of ``points (K, 3)`` lies before the arch, at the height of the teeth or not."""
        return np.asarray(arch_distance(points, self.front, self.bend)[0], np.float64)


def arch_distance(places: _Places, front: float | _Places, bend: float | _Places) -> tuple[_Places, _Places]:
    """Distance ``(K,)`` m, positive in front, and normal ``(K, 2)`` (x, z) of the surface z = front - bend x^2.

    To first order (Taubin 1991): exact on the surface, and near enough within the thickness of a lip.
    """
    x, z = places[:, 0], places[:, 2]
    slope = 2 * bend * x
    steepness = np.sqrt(1 + slope * slope)
    normal = np.stack([slope, np.ones_like(slope)], axis=1) / steepness[:, None]
    return (z - front + bend * x * x) / steepness, normal


def fit_arch(model: HeadModel, part: str) -> Arch:
    """The parabola that touches the teeth ``part`` and has those behind the lips inside."""
    points, crowns, upper = _rows(model, part)
    front, bend = _parabola(points, _WIDER * float(model.landmarks["mouth_corner_l"][0]), _SLICES)
    edge = float(crowns[:, 1].min() - _EDGE_MARGIN if upper else crowns[:, 1].max() + _EDGE_MARGIN)
    return Arch(front, bend, edge, _FADE if upper else -_FADE)


def fit_crowns(model: HeadModel, part: str) -> Arch:
    """The parabola that touches the crowns of the front teeth of ``part`` near their edges, without their gum."""
    _, crowns, upper = _rows(model, part)
    middle = crowns[np.abs(crowns[:, 0]) < _INCISORS][:, 1]
    edge = float(middle.min() if upper else middle.max())
    front, bend = _parabola(crowns[np.abs(crowns[:, 1] - edge) < _NEAR_EDGE], _FRONT_TEETH, _FRONT_SLICES)
    return Arch(front, bend, edge, _FADE if upper else -_FADE)


def _rows(model: HeadModel, part: str) -> tuple[Doubles, Doubles, bool]:
    """The vertices of a row of teeth with their gum, those of the crowns, and whether it is the upper row."""
    mesh = model.parts[part]
    points = mesh.attributes["POSITION"].astype(np.float64)
    crowns = points[mesh.attributes["_MATERIAL"][:, 0] > 0]
    return points, crowns, bool(crowns[:, 1].mean() < points[:, 1].mean())


def _parabola(points: Doubles, wide: float, slices: int) -> tuple[float, float]:
    """``front, bend`` of z = front - bend x^2 that has ``points`` up to ``wide`` m from the middle behind it."""
    x = np.abs(points[:, 0])
    inside = [points[(x >= a) & (x <= b)] for a, b in pairwise(np.linspace(0.0, wide, slices + 1))]
    outer = np.array([of_slice[of_slice[:, 2].argmax()] for of_slice in inside if len(of_slice)])
    system = np.stack([np.ones(len(outer)), -(outer[:, 0] ** 2)], axis=1)
    bend = float(np.linalg.lstsq(system, outer[:, 2], rcond=None)[0][1])
    return float((outer[:, 2] + bend * outer[:, 0] ** 2).max()), bend
