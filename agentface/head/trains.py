"""Trains of wrinkles on the face at rest: rows of parabolas between two lines of the skin (Bui et al., section 4).

A train gives every point of the skin a height; what a contraction makes of it is
:mod:`agentface.deform.finish.wrinkles`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles, Floats

_WAVE = 5.0  # wrinkles' widths, along them, in which they wander once
_CREASE = 0.16  # of a wrinkle's width, how far from its foot a crease is dark
_WIDEST_CREASE = 2.2e-3  # m


def parabolas(distance: Doubles, length: float, count: int, height: float) -> Doubles:
    """``a (1 - (u - b)^2 / b^2)``: ``count`` wrinkles in a row over ``0..length``, 0 outside and at every foot.

    ``b = L / (2 Nw)`` and ``u = l - floor(l Nw / L) L / Nw``; the print has an undefined ``x`` in place of this ``l``.
    """
    b = length / (2 * count)
    u = distance - np.floor(distance * count / length) * (2 * b)
    inside = (distance >= 0.0) & (distance <= length)
    return np.where(inside, height * np.maximum(1.0 - (u - b) ** 2 / b**2, 0.0), 0.0)


class Train(Protocol):
    """Where wrinkles rise, and how high at full contraction."""

    @property
    def count(self) -> int:
        """Nw."""

    @property
    def height(self) -> float:
        """a, m."""

    @property
    def shade(self) -> float:
        """How dark the creases are, 0..1."""

    @property
    def length(self) -> float:
        """L, m: how far the train reaches across its wrinkles."""

    def place(self, points: Floats) -> tuple[Doubles, Doubles]:
        """Of points ``(N, 3)``: the distance l into the train in metres and the weight 0..1 of its sides."""

    def ends(self) -> tuple[float, float]:
        """The parts 0..1 of the length over which the first and the last wrinkles flatten."""


def heights(train: Train, points: Floats) -> Doubles:
    """``(N,)`` m: how high a train raises points of the skin at rest at full contraction."""
    return relief(train, points)[0]


def relief(train: Train, points: Floats) -> tuple[Doubles, Doubles]:
    """Of points ``(N, 3)`` at rest: heights in metres at full contraction, and how deep in a crease they are, 0..1.

    Creases are the feet between the wrinkles, and those at the ends of the train as far as these are steep.
    """
    distance, weight = train.place(points)
    raised = parabolas(distance, train.length, train.count, train.height)
    width = train.length / train.count
    foot = np.clip(np.round(distance / width), 0, train.count)
    near = np.exp(-(((distance - width * foot) / min(_CREASE * width, _WIDEST_CREASE)) ** 2))
    steep = [max(0.0, 1.0 - 4.0 * end) for end in train.ends()]
    flattened = _flattened(train, distance)
    crease = np.where(foot == 0, steep[0], np.where(foot == train.count, steep[1], flattened)) * near
    return weight * flattened * raised, train.shade * weight * crease


def inner_feet(train: Train, points: Floats, tolerance: float) -> npt.NDArray[np.bool_]:
    """``(N,)`` true for points on a foot between two wrinkles, ``l = 2b, 4b, ... L - 2b``, to ``tolerance`` metres."""
    distance, weight = train.place(points)
    width = train.length / train.count
    foot = np.round(distance / width)
    between = (foot >= 1) & (foot <= train.count - 1) & (weight > 0.0)
    on_foot: npt.NDArray[np.bool_] = between & (np.abs(distance - width * foot) <= tolerance)
    return on_foot


def _flattened(train: Train, distance: Doubles) -> Doubles:
    first, last = train.ends()
    part = distance / train.length
    rise = _smooth(part / first) if first else 1.0
    return np.asarray(rise * (_smooth((1.0 - part) / last) if last else 1.0), np.float64)


def _smooth(t: Doubles) -> Doubles:
    t = np.clip(t, 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


@dataclass(frozen=True, slots=True)
class ZoneTrain:
    """The paper's train: in a vector muscle's zone, from the chord at its rim three quarters of the way to the bone.

    The paper ends the wrinkles at the zone's sides in a cliff; here they fade with the angle from the axis, like the
    muscle's own pull.

    Attributes:
        origin: ``(3,)`` m, v1.
        axis: ``(3,)`` unit vector from v1 towards the insertion.
        zone: rad, half the angle of the zone.
        finish: Rf, m.
        count, height: Nw, and a in metres.
        shade: 0..1, how dark the creases are.
    """

    origin: Doubles
    axis: Doubles
    zone: float
    finish: float
    count: int
    height: float
    shade: float = 1.0

    @property
    def length(self) -> float:
        """L = 3/4 |v1 v3| = 3/4 Rf cos(theta)."""
        return 0.75 * self.finish * float(np.cos(self.zone))

    def ends(self) -> tuple[float, float]:
        """As in the paper: every wrinkle is as high as the others."""
        return 0.0, 0.0

    def place(self, points: Floats) -> tuple[Doubles, Doubles]:
        """The distance from the chord, along the axis; the weight is 1 on the axis and 0 at the zone's sides."""
        spoke = points.astype(np.float64) - self.origin
        along = spoke @ self.axis
        cosine = along / np.maximum(np.linalg.norm(spoke, axis=1), 1e-12)
        edge = np.cos(self.zone)
        return self.finish * edge - along, _smooth((cosine - edge) / (1.0 - edge))


@dataclass(frozen=True, slots=True)
class DrawnTrain:
    """A train drawn on the face: wrinkles across the way from ``start``, straight, bowed or like a fan.

    With a ``bow`` the wrinkles are arcs about the point ``start + along / bow``; those of a fan are the spokes about
    the point ``start + across / bow``.

    Attributes:
        start: ``(3,)`` m.
        along, across: ``(3,)`` unit vectors: of l and of the wrinkles at ``start``.
        length, count, height: L in metres, Nw, a in metres.
        bow: 1/m, the curvature of the wrinkles.
        fan: whether the wrinkles are spokes.
        aside, half_width: m along the wrinkles: the middle of the train from ``start``, and how far it reaches.
        flat: 0..1, the part of ``half_width`` over which it does not yet fade.
        taper: see :meth:`Train.ends`.
        waver: m, how far the wrinkles wander.
        uneven: 0..1, how much lower than ``height`` they are here and there.
        shade: 0..1, how dark the creases are.
    """

    start: Doubles
    along: Doubles
    across: Doubles
    length: float
    count: int
    height: float
    bow: float
    fan: bool
    aside: float
    half_width: float
    flat: float
    taper: tuple[float, float]
    waver: float
    uneven: float
    shade: float

    def ends(self) -> tuple[float, float]:
        """The parts over which the first and the last wrinkles flatten."""
        return self.taper

    def place(self, points: Floats) -> tuple[Doubles, Doubles]:
        """The distance along the train, or round its centre for a fan, and the weight 0..1 along the wrinkles."""
        spoke = points.astype(np.float64) - self.start
        along, across = spoke @ self.along, spoke @ self.across
        distance, aside = _about(across, along, self.bow)[::-1] if self.fan else _about(along, across, self.bow)
        turn = 2.0 * np.pi * aside / (_WAVE * self.length / self.count)
        if self.waver:
            distance = distance + self.waver * (np.cos(turn) + 0.6 * np.cos(2.3 * turn + 4.0 * distance / self.length))
        off = np.abs(aside - self.aside) / self.half_width
        lower = 0.5 + 0.5 * np.cos(0.7 * turn) * np.cos(2.2 * distance * self.count / self.length + 1.0)
        return distance, (1.0 - _smooth((off - self.flat) / (1.0 - self.flat))) * (1.0 - self.uneven * lower)


def _about(towards: Doubles, beside: Doubles, bow: float) -> tuple[Doubles, Doubles]:
    """Distance from the circle through 0 about ``(1 / bow, 0)`` towards its centre, and the arc along the circle."""
    radius = np.hypot(1.0 - bow * towards, bow * beside)
    inward = (2.0 * towards - bow * (towards * towards + beside * beside)) / (1.0 + radius)
    return inward, np.arctan2(bow * beside, 1.0 - bow * towards) / bow if bow else beside
