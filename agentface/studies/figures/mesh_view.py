"""A mesh drawn as shaded, wired triangles: parallel projection, far triangles first."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Doubles, Floats, Indices

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

_LIGHT = np.array([-0.35, 0.5, 0.8]) / np.linalg.norm([-0.35, 0.5, 0.8])
SKIN = np.array([226.0, 205.0, 190.0])
FOLDED = np.array([214.0, 58.0, 48.0])
_WIRE = 0.62  # of the triangle's own colour

Colour = tuple[int, int, int]


@dataclass(frozen=True, slots=True)
class MeshView:
    """A parallel projection onto a square picture.

    Attributes:
        centre: ``(3,)`` m, the point in the middle.
        width: m, what the picture's side covers.
        yaw_deg: how far the eye stands to the person's left of straight ahead.
        size: the picture's side in pixels.
    """

    centre: Floats
    width: float
    yaw_deg: float
    size: int

    def turned(self, vectors: Doubles) -> Doubles:
        """``(N, 3)`` vectors with x to the right, y up and z towards the eye."""
        yaw = math.radians(self.yaw_deg)
        turn = np.array([[math.cos(yaw), 0, -math.sin(yaw)], [0, 1, 0], [math.sin(yaw), 0, math.cos(yaw)]])
        return np.asarray(vectors, np.float64) @ turn.T

    def pixels(self, points: Doubles) -> Doubles:
        """``(N, 3)``: column and row in pixels, and depth towards the eye in metres."""
        seen = self.turned(points - self.centre)
        scale = self.size / self.width
        seen[:, :2] = self.size / 2 + scale * seen[:, :2] * [1, -1]
        return seen


def folded(rest: Doubles, moved: Doubles, triangles: Indices) -> np.typing.NDArray[np.bool_]:
    """``(T,)`` true where a triangle has turned over: its normal is more than 90 degrees from that at rest."""
    turned_over: np.typing.NDArray[np.bool_] = (_normals(rest, triangles) * _normals(moved, triangles)).sum(1) < 0.0
    return turned_over


def draw_mesh(draw: ImageDraw, view: MeshView, rest: Doubles, moved: Doubles, triangles: Indices) -> None:
    """Draw ``moved`` ``(V, 3)``: triangles that faced the eye at rest, those that are turned over in red."""
    facing = triangles[view.turned(_normals(rest, triangles))[:, 2] > 0.0]
    pixels = view.pixels(moved)
    corners = pixels[facing]
    inside = ((corners[..., :2] > -view.size / 4) & (corners[..., :2] < 1.25 * view.size)).all((1, 2))
    facing, corners = facing[inside], corners[inside]
    normals = view.turned(_normals(moved, facing))
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    base = np.where(folded(rest, moved, facing)[:, None], FOLDED, SKIN)
    colours = base * (0.55 + 0.45 * np.abs(normals @ _LIGHT))[:, None]
    for i in np.argsort(corners[..., 2].mean(1), kind="stable"):
        places = [(float(x), float(y)) for x, y in corners[i, :, :2]]
        draw.polygon(places, fill=_colour(colours[i]))
        draw.line([*places, places[0]], fill=_colour(_WIRE * colours[i]), width=2)


def draw_arrow(draw: ImageDraw, view: MeshView, ends: Sequence[Doubles], colour: Colour) -> None:
    """A muscle as a line from the skin end ``ends[1]`` to a dot at the bone end ``ends[0]``."""
    (bx, by, _), (sx, sy, _) = view.pixels(np.array(ends))
    for width, shade in ((14, (255, 255, 255)), (8, colour)):
        draw.line([(bx, by), (sx, sy)], fill=shade, width=width)
        radius = width * 1.4
        draw.ellipse([bx - radius, by - radius, bx + radius, by + radius], fill=shade)


def _normals(points: Doubles, triangles: Indices) -> Doubles:
    a, b, c = (np.asarray(points, np.float64)[triangles[:, i]] for i in range(3))
    return np.cross(b - a, c - a)


def _colour(values: Doubles) -> Colour:
    red, green, blue = (int(value) for value in np.clip(values, 0, 255))
    return red, green, blue
