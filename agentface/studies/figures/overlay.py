"""A drawn face with lines, areas and labels over it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from io import BytesIO
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Bytes, Doubles, Floats
from agentface.deform.geometry import FaceGeometry
from agentface.studies.figures.mesh_view import Colour
from agentface.view.camera import Camera
from agentface.view.contact_sheet import INK
from agentface.view.renderer import Renderer

if TYPE_CHECKING:
    from PIL.Image import Image

FINER = 2
"""Pixels of the canvas a pixel of the picture."""
_FONT = 17
_COLOURS, _ROUNDS = 256, 2
_PAPER = 247  # what is lighter in all channels is white
_TINT, _BRIGHT = 0.8, 165.0  # of a tint, how much covers; the light at which it is as it was named

Place = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Label:
    """What a place of the picture is called: ``at`` is the place, in pixels of the canvas."""

    text: str
    at: Place
    colour: Colour = INK


class Canvas:
    """A picture on white with margins at both sides, drawn ``FINER`` times as large as it will be.

    Args:
        renderer: draws the face.
        geometry: the face at one instant.
        camera: sees the part between the margins.
        size: width and height of the part between the margins, in pixels of the finished picture.
        margin: width of either margin.
        fade: how much of the face is lost in white, 0..1.
    """

    def __init__(
        self,
        renderer: Renderer,
        geometry: FaceGeometry,
        camera: Camera,
        size: tuple[int, int],
        margin: int,
        fade: float = 0.0,
    ) -> None:
        from PIL import Image as Images
        from PIL import ImageDraw

        self._camera, self._margin = camera, FINER * margin
        self._inside = FINER * size[0], FINER * size[1]
        drawn = renderer.render(geometry, self._inside, camera, "portrait", alpha=True)
        self.image = Images.new("RGB", (self._inside[0] + 2 * self._margin, self._inside[1]), (255, 255, 255))
        self.image.paste(Images.fromarray(drawn[..., :3]), (self._margin, 0), Images.fromarray(drawn[..., 3]))
        if fade:
            self.image = Images.blend(self.image, Images.new("RGB", self.image.size, (255, 255, 255)), fade)
        self.pen = ImageDraw.Draw(self.image, "RGBA")

    def pixels(self, points: Floats | Doubles) -> Doubles:
        """``(N, 2)`` pixels of the canvas where ``points (N, 3)`` m are seen."""
        width, height = self._inside
        matrix = self._camera.projection(width / height) @ self._camera.view()
        seen = np.column_stack([np.asarray(points, np.float64), np.ones(len(points))]) @ matrix.T
        places = 0.5 + 0.5 * seen[:, :2] / seen[:, 3:] * [1, -1]
        return places * [width, height] + [self._margin, 0.0]

    def tint(self, layer: Bytes, colours: Sequence[Colour]) -> None:
        """Colour the face where ``layer (H, W)`` is not 0, by ``colours[layer - 1]`` and its own light."""
        from PIL import Image as Images
        from PIL import ImageDraw

        picture = np.asarray(self.image, np.float64)
        light = picture.mean(axis=2, keepdims=True) / _BRIGHT
        coloured = np.asarray([(0, 0, 0), *colours], np.float64)[layer] * light
        mixed = np.where(layer[..., None] > 0, _TINT * coloured + (1.0 - _TINT) * picture, picture)
        self.image = Images.fromarray(np.clip(mixed, 0, 255).astype(np.uint8))
        self.pen = ImageDraw.Draw(self.image, "RGBA")

    def line(self, points: Doubles, colour: tuple[int, ...], width: float) -> None:
        """A line through ``points (N, 2)``, ``width`` pixels of the finished picture wide."""
        self.pen.line([_pair(point) for point in points], fill=colour, width=round(FINER * width), joint="curve")

    def dot(self, point: Doubles, colour: tuple[int, ...], radius: float) -> None:
        """A filled circle."""
        (x, y), r = _pair(point), FINER * radius
        self.pen.ellipse([x - r, y - r, x + r, y + r], fill=colour)

    def label(self, labels: Sequence[Label], *, right: bool, gap: float = 6.0) -> None:
        """Write ``labels`` one below the other into a margin, in the order of their places, each with a line to it."""
        from PIL import ImageFont

        font = ImageFont.load_default(FINER * _FONT)
        ordered = sorted(labels, key=lambda label: label.at[1])
        rows = _spread([label.at[1] for label in ordered], FINER * (_FONT + gap), self.image.height)
        edge = self.image.width - self._margin if right else self._margin
        for label, row in zip(ordered, rows, strict=True):
            outward = FINER * (10.0 if right else -10.0)
            self.pen.line([(edge + outward, row), (edge, row), label.at], fill=label.colour, width=FINER, joint="curve")
            for colour, radius in (((255, 255, 255), 3.4), (label.colour, 2.2)):
                self.dot(np.array(label.at), colour, radius)
            place = edge + 1.6 * outward, row
            self.pen.text(place, label.text, fill=label.colour, font=font, anchor="lm" if right else "rm")

    def png(self) -> bytes:
        """The finished picture as a PNG file."""
        from PIL import Image

        width, height = self.image.size
        return in_colours(self.image.resize((width // FINER, height // FINER), Image.Resampling.BOX))


def in_colours(image: Image) -> bytes:
    """A PNG file in 256 colours, one of them white as it is: paper stays paper."""
    from PIL import Image as Images

    picked = image.quantize(_COLOURS - 1, method=Images.Quantize.MEDIANCUT, kmeans=_ROUNDS).getpalette() or []
    colours = np.array([*picked[: 3 * (_COLOURS - 1)], 255, 255, 255], np.uint8).reshape(-1, 3)
    colours[colours.min(axis=1) > _PAPER] = 255
    palette = Images.new("P", (1, 1))
    palette.putpalette(colours.tobytes())
    buffer = BytesIO()
    image.quantize(palette=palette, dither=Images.Dither.FLOYDSTEINBERG).save(buffer, "PNG", optimize=True)
    return buffer.getvalue()


def _spread(wanted: Sequence[float], apart: float, height: float) -> list[float]:
    """Rows as near to those ``wanted``, which ascend, as lets them stand ``apart`` and inside ``0..height``."""
    if not wanted:
        return []
    steps = apart * np.arange(len(wanted))
    rows = _ascending(np.asarray(wanted) - steps) + steps
    low, high = 0.5 * apart, height - 0.5 * apart
    rows = np.maximum(np.minimum(rows, high - steps[::-1]), low + steps)
    return [float(row) for row in rows]


def _ascending(values: Doubles) -> Doubles:
    """The ascending values nearest to ``values`` in the least-squares sense: pools of neighbours share their mean."""
    pools: list[tuple[float, int]] = []
    for value in values:
        pools.append((float(value), 1))
        while len(pools) > 1 and pools[-2][0] > pools[-1][0]:
            (a, n), (b, m) = pools[-2:]
            pools[-2:] = [((n * a + m * b) / (n + m), n + m)]
    return np.concatenate([np.full(count, mean) for mean, count in pools])


def _pair(point: Doubles) -> Place:
    return float(point[0]), float(point[1])
