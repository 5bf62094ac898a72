"""Solid things drawn with light, shade and a depth buffer: bone, muscle, teeth; and lines that these hide."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from agentface.conventions import Bytes, Doubles, Indices
from agentface.mesh.normals import vertex_normals
from agentface.studies.figures.gouraud import fill
from agentface.studies.figures.mesh_view import MeshView

FINER = 2
"""Pixels of the scene a pixel of the picture, in each direction."""
_LIGHTS = ((0.62, (-0.5, 0.55, 0.7)), (0.22, (0.75, 0.1, 0.55)), (0.16, (0.0, -0.6, 0.6)))
"""How bright each of the three lights is, and where it comes from: right, up, towards the eye."""
_AMBIENT, _INSIDE = 0.26, 0.45
_HOLLOWS = ((0.9, 0.0035), (0.8, 0.012))
"""How much darker hollows are, and how wide those are, m."""
_COLOUR, _NORMAL = np.s_[0:3], np.s_[3:6]


class Scene:
    """A picture on white that solid things are put into one after the other.

    Args:
        view: sees it; its size is that of the finished picture.
    """

    def __init__(self, view: MeshView) -> None:
        self.size = view.size
        self._view = MeshView(view.centre, view.width, view.yaw_deg, FINER * view.size)
        side = self._view.size
        self._values, self._near = np.zeros((side, side, 6)), np.full((side, side), -np.inf)
        self._lines: list[tuple[Doubles, tuple[int, ...], float]] = []

    def surface(
        self,
        points: Doubles,
        triangles: Indices,
        colours: Doubles,
        kept: Doubles | None = None,
        normals: Doubles | None = None,
    ) -> None:
        """Put in ``points (V, 3)`` m of ``colours (V, 3)`` or ``(3,)``, with other ``normals (V, 3)`` than their own.

        With ``kept (V, C)``, only where none of these is negative.
        """
        facing = self._view.turned(vertex_normals(points, triangles) if normals is None else normals)
        colours = np.broadcast_to(np.asarray(colours, np.float64), points.shape)
        kept = np.zeros((len(points), 0)) if kept is None else kept
        triangles = triangles[np.all(np.any(kept[triangles] >= 0.0, axis=1), axis=1)]
        own = np.concatenate([colours, facing, kept], axis=1)[triangles]
        values = np.concatenate([self._values, np.zeros((*self._near.shape, kept.shape[1]))], axis=2)
        fill(values, self._near, self._view.pixels(points)[triangles], own, kept.shape[1])
        self._values = values[..., :6]

    def net(self, points: Doubles, edges: Indices, colour: tuple[int, ...], width: float, above: float = 0.0) -> None:
        """Draw ``edges (E, 2)`` between ``points (V, 3)`` m, ``width`` pixels wide, where nothing is nearer.

        What lies less than ``above`` m deeper than the nearest is drawn still; call it when all surfaces are in.
        """
        pieces = np.linspace(0.0, 1.0, 7)
        start, end = self._view.pixels(points)[edges].swapaxes(0, 1)
        along = start[:, None] + pieces[:, None] * (end - start)[:, None]
        middle = 0.5 * (along[:, 1:] + along[:, :-1])
        column, row = (np.clip(middle[..., axis].astype(int), 0, self._view.size - 1) for axis in (0, 1))
        seen = middle[..., 2] > self._near[row, column] - above
        ends = np.stack([along[:, :-1, :2], along[:, 1:, :2]], axis=2)[seen]
        self._lines.append((ends, colour, width))

    def picture(self) -> Bytes:
        """``(S, S, 3)``: the scene with its light."""
        from PIL import Image, ImageDraw

        image = Image.fromarray(self._shaded())
        pen = ImageDraw.Draw(image, "RGBA")
        for pieces, colour, width in self._lines:
            for piece in pieces:
                pen.line([(float(x), float(y)) for x, y in piece], fill=colour, width=round(FINER * width))
        return np.asarray(image.resize((self.size, self.size), Image.Resampling.BOX))

    def _shaded(self) -> Bytes:
        there = np.isfinite(self._near)
        normals = self._values[..., _NORMAL] / np.maximum(
            np.linalg.norm(self._values[..., _NORMAL], axis=2, keepdims=True), 1e-9
        )
        behind = normals[..., 2] < 0.0
        light = _AMBIENT + sum(
            bright * np.clip(np.where(behind[..., None], -normals, normals) @ _unit(way), 0.0, 1.0)
            for bright, way in _LIGHTS
        )
        light = light * np.where(behind, _INSIDE, 1.0) * self._openness(there, np.abs(normals[..., 2]))
        shown = np.where(there[..., None], self._values[..., _COLOUR] * light[..., None], 255.0)
        return np.round(np.clip(shown, 0, 255)).astype(np.uint8)

    def _openness(self, there: np.typing.NDArray[np.bool_], facing: Doubles) -> Doubles:
        """``(S, S)`` 0..1: hollows are darker, by how far they lie under what is round them.

        Half of what is round a slope is higher, but at an outline there is only that half: hence ``facing``.
        """
        from scipy.ndimage import gaussian_filter

        depth, part = np.where(there, self._near, 0.0), there.astype(np.float64)
        result = np.ones_like(depth)
        for much, wide in _HOLLOWS:
            pixels = wide * self._view.size / self._view.width
            mean = gaussian_filter(depth, pixels) / np.maximum(gaussian_filter(part, pixels), 1e-6)
            result *= 1.0 - much * facing * np.clip((mean - depth) / (3.0 * wide), 0.0, 0.8)
        return np.asarray(result)


def _unit(way: Sequence[float]) -> Doubles:
    return np.asarray(way) / np.linalg.norm(way)
