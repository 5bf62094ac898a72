"""The space that a row of teeth leaves to the tongue, and a tongue at rest inside it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from agentface.conventions import Doubles
from agentface.mesh.glb import MeshArrays, Shape

_DEEP = {"teeth_lower": 0.0065, "teeth_upper": 0.0125}
"""m from the edges of the teeth: what of each row a tongue between them may touch."""
_MIDDLE = 0.003  # m from the median plane, where the row is nearest to the lips
_REACH = 0.97  # of the way there, beyond which a tooth says nothing about the width
CLEAR = 0.0008
"""m that the tongue at rest keeps from the teeth."""
_BLUNT = 0.0025  # m from the incisors to the tip, where an arch is wide enough for it to be round
_STATIONS = 33
_NARROWEST = 0.3


@dataclass(frozen=True, slots=True)
class Wall:
    """The inner side of a row of teeth: half an ellipse in the horizontal plane, open and straight behind it.

    Attributes:
        middle: m, the x of its axis.
        back: m, the z from which on it narrows.
        depth: m, from there to the front.
        width: m, half of it at the back.
        edge: m, the height of the teeth's free edges.
    """

    middle: float
    back: float
    depth: float
    width: float
    edge: float

    @property
    def front(self) -> float:
        """The z of the inner side of the incisors, m."""
        return self.back + self.depth

    def half_width(self, z: Doubles, clear: float = 0.0) -> Doubles:
        """``(K,)`` m: how far aside each z is free; ``clear`` m from the teeth."""
        along = np.clip((z - self.back) / (self.depth - clear), 0.0, 1.0)
        return np.asarray((self.width - clear) * np.sqrt(1.0 - along * along))


def fit_wall(row: MeshArrays, name: str, middle: float = 0.0) -> Wall:
    """The largest such ellipse about ``middle`` m with the teeth of ``row``, the part of that ``name``, outside it."""
    points = row.attributes["POSITION"].astype(np.float64)
    tooth = row.attributes["_MATERIAL"][:, 0] > 0
    upper = name == "teeth_upper"
    edge = float(points[tooth, 1].min() if upper else points[tooth, 1].max())
    near = points[np.abs(points[:, 1] - edge) < _DEEP[name]]
    aside = np.abs(near[:, 0] - middle)
    front, back = float(near[aside < _MIDDLE, 2].min()), float(points[tooth, 2].min())
    along = np.clip((near[:, 2] - back) / (front - back), 0.0, None)
    telling = along < _REACH
    width = float((aside[telling] / np.sqrt(1.0 - along[telling] ** 2)).min())
    return Wall(middle, back, front - back, width, edge)


def between_the_teeth(tongue: MeshArrays, teeth: dict[str, MeshArrays]) -> MeshArrays:
    """``tongue`` made short and narrow enough to lie within both rows of ``teeth`` when these meet.

    The artists' tongue is as large as that of a head whose arch is as wide as its cheeks. Its shapes lead to where
    they have led, from the new rest.
    """
    walls = [fit_wall(row, name) for name, row in teeth.items()]
    drawn = tongue.attributes["POSITION"].astype(np.float64)
    points = drawn.copy()
    middle = 0.5 * float(points[:, 0].min() + points[:, 0].max())  # its own: it stays its mirror image
    root, tip = points[:, 2].min(), points[:, 2].max()
    room = min(wall.front for wall in walls) - _BLUNT - root
    points[:, 2] = root + (points[:, 2] - root) * min(1.0, room / (tip - root))
    at = np.linspace(points[:, 2].min(), points[:, 2].max(), _STATIONS)
    free = np.minimum(*(wall.half_width(at, CLEAR) for wall in walls))
    wide = _half_widths(points[:, 0] - middle, points[:, 2], at)
    part = np.clip(free / wide, _NARROWEST, 1.0)
    aside = (points[:, 0] - middle) * np.interp(points[:, 2], at, _evened(part))
    limit = np.interp(points[:, 2], at, free)
    points[:, 0] = middle + np.clip(aside, -limit, limit)
    shapes = {name: _whole(shape.dense(len(points)) + (drawn - points)) for name, shape in tongue.shapes.items()}
    return replace(tongue, attributes={**tongue.attributes, "POSITION": points.astype(np.float32)}, shapes=shapes)


def _whole(way: Doubles) -> Shape:
    return Shape(np.arange(len(way), dtype=np.int32), way.astype(np.float32))


def _half_widths(aside: Doubles, z: Doubles, at: Doubles) -> Doubles:
    step = at[1] - at[0]
    return np.array([np.abs(aside[np.abs(z - place) <= 1.5 * step]).max(initial=1e-4) for place in at])


def _evened(values: Doubles) -> Doubles:
    for _ in range(4):
        padded = np.pad(values, 1, mode="edge")
        values = np.minimum(values, 0.25 * padded[:-2] + 0.5 * padded[1:-1] + 0.25 * padded[2:])
    return values
