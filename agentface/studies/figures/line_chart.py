"""Charts of lines over time, drawn with Pillow."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Doubles
from agentface.studies.figures.bar_chart import tick
from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import FINER
from agentface.view.contact_sheet import INK

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

COLOURS: tuple[Colour, ...] = (
    (214, 140, 20),
    (49, 104, 168),
    (190, 50, 50),
    (120, 76, 160),
    (84, 130, 44),
    (24, 150, 150),
    (150, 110, 80),
    (90, 90, 96),
)
_LEFT, _TOP, _RIGHT, _BOTTOM = 44, 58, 14, 30
"""Pixels that the axes and the legend have."""
_GRID: Colour = (226, 226, 230)
_FAINT: Colour = (120, 120, 126)


@dataclass(frozen=True)
class ChartLine:
    """Values ``(N,)`` at the times of its chart, in ``COLOURS[colour]``; a thin one is a reference."""

    name: str
    values: Doubles
    colour: int
    thin: bool = False


@dataclass(frozen=True)
class LineChart:
    """Lines over ``times (N,)`` in seconds, within ``low..high``; lines without a name are not in the legend."""

    times: Doubles
    lines: Sequence[ChartLine]
    low: float = 0.0
    high: float = 1.0
    size: tuple[int, int] = (560, 300)

    def picture(self) -> Image:
        """The chart."""
        from PIL import Image, ImageDraw

        image = Image.new("RGB", (FINER * self.size[0], FINER * self.size[1]), (255, 255, 255))
        pen = ImageDraw.Draw(image)
        self._axes(pen)
        for line in self.lines:
            points = np.stack([self._column(self.times), self._row(line.values)], axis=1)
            width = FINER * (1 if line.thin else 2)
            pen.line([(FINER * x, FINER * y) for x, y in points], fill=COLOURS[line.colour], width=width, joint="curve")
        self._legend(pen)
        return image.resize(self.size, Image.Resampling.BOX)

    def _column(self, times: Doubles) -> Doubles:
        share = (times - self.times[0]) / (self.times[-1] - self.times[0])
        return _LEFT + (self.size[0] - _LEFT - _RIGHT) * share

    def _row(self, values: Doubles) -> Doubles:
        share = (values - self.low) / (self.high - self.low)
        return self.size[1] - _BOTTOM - (self.size[1] - _TOP - _BOTTOM) * share

    def _axes(self, pen: ImageDraw) -> None:
        left, right, bottom = FINER * _LEFT, FINER * (self.size[0] - _RIGHT), FINER * (self.size[1] - _BOTTOM)
        for value in _steps(self.low, self.high):
            row = FINER * float(self._row(value))
            pen.line([(left, row), (right, row)], fill=INK if value == 0.0 else _GRID, width=FINER)
            self._text(pen, (_LEFT - 6, row / FINER), f"{value + 0.0:g}", "rm", _FAINT)
        for time in _steps(float(self.times[0]), float(self.times[-1])):
            column = FINER * float(self._column(time))
            pen.line([(column, bottom), (column, bottom + 4 * FINER)], fill=INK, width=FINER)
            self._text(pen, (column / FINER, self.size[1] - _BOTTOM + 16), f"{time + 0.0:g} s", "mm", _FAINT)

    def _legend(self, pen: ImageDraw) -> None:
        left, row = float(_LEFT), 14.0
        for line in self.lines:
            wide = 34.0 + 7.4 * len(line.name)
            if not line.name:
                continue
            if left + wide > self.size[0]:
                left, row = float(_LEFT), row + 18.0
            ends = [(FINER * left, FINER * row), (FINER * (left + 16.0), FINER * row)]
            pen.line(ends, fill=COLOURS[line.colour], width=FINER * (1 if line.thin else 3))
            self._text(pen, (left + 21.0, row), line.name, "lm")
            left += wide

    @staticmethod
    def _text(pen: ImageDraw, place: tuple[float, float], text: str, anchor: str, colour: Colour = INK) -> None:
        from PIL import ImageFont

        font = ImageFont.load_default(FINER * 13)
        pen.text((FINER * place[0], FINER * place[1]), text, fill=colour, font=font, anchor=anchor)


def _steps(low: float, high: float) -> Doubles:
    step = tick(high - low)
    return step * np.arange(np.ceil(low / step - 1e-9) + 0.0, np.floor(high / step + 1e-9) + 1.0)
