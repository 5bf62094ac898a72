"""Charts of bars, drawn with Pillow: groups side by side, parts on top of each other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from agentface.studies.figures.mesh_view import Colour
from agentface.studies.figures.overlay import FINER
from agentface.view.contact_sheet import INK

if TYPE_CHECKING:
    from PIL.Image import Image
    from PIL.ImageDraw import ImageDraw

_LEFT, _TOP, _RIGHT, _BOTTOM = 58, 64, 14, 34
"""Pixels that the axes, the legend and the groups' names have."""
_GRID: Colour = (222, 222, 226)
_FAINT: Colour = (120, 120, 126)
_GAP = 0.24
"""Of a group's width, left and right of its bars together."""
_TICKS = 5

Bar = Sequence[float | None]
"""The parts of a bar, from the lowest up; None where there is no number."""


@dataclass(frozen=True)
class Chart:
    """A chart.

    Attributes:
        unit: of the axis, as it is written over it.
        parts: the colours of the bars' parts, by name: for each bar of a group its parts, in their order.
        groups: for each name on the axis its bars.
        size: of the picture.
    """

    unit: str
    parts: Sequence[Mapping[str, Colour]]
    groups: Mapping[str, Sequence[Bar]]
    size: tuple[int, int] = (560, 340)

    @property
    def top(self) -> float:
        """Where the axis ends: a round number above the highest bar."""
        highest = max((sum(part or 0.0 for part in bar) for bars in self.groups.values() for bar in bars), default=0.0)
        step = tick(highest)
        return step * max(1, math.ceil(highest / step - 1e-9))

    def picture(self) -> Image:
        """The chart."""
        from PIL import Image, ImageDraw

        image = Image.new("RGB", (FINER * self.size[0], FINER * self.size[1]), (255, 255, 255))
        pen = ImageDraw.Draw(image)
        self._axis(pen)
        self._legend(pen)
        wide = (self.size[0] - _LEFT - _RIGHT) / len(self.groups)
        for place, (name, bars) in enumerate(self.groups.items()):
            left = _LEFT + place * wide
            _text(pen, (left + 0.5 * wide, self.size[1] - 0.5 * _BOTTOM), name, 15, "mm")
            each = (1.0 - _GAP) * wide / len(bars)
            for number, bar in enumerate(bars):
                self._bar(pen, left + 0.5 * _GAP * wide + number * each, each, bar, self.parts[number])
        return image.resize(self.size, Image.Resampling.BOX)

    def _row(self, value: float) -> float:
        high = self.size[1] - _TOP - _BOTTOM
        return _TOP + high * (1.0 - value / self.top)

    def _axis(self, pen: ImageDraw) -> None:
        step = tick(self.top)
        for number in range(round(self.top / step) + 1):
            row = self._row(number * step)
            ends = [(FINER * _LEFT, FINER * row), (FINER * (self.size[0] - _RIGHT), FINER * row)]
            pen.line(ends, fill=_GRID if number else INK, width=FINER)
            _text(pen, (_LEFT - 8, row), f"{number * step:g}", 13, "rm", _FAINT)
        _text(pen, (_LEFT - 8, _TOP - 22), self.unit, 13, "rm", _FAINT)

    def _legend(self, pen: ImageDraw) -> None:
        left, row = float(_LEFT), 18.0
        shown: dict[str, Colour] = {name: colour for parts in self.parts for name, colour in parts.items()}
        for name, colour in shown.items():
            wide = 30 + _length(name, 14)
            if left + wide > self.size[0] - _RIGHT:
                left, row = float(_LEFT), row + 20
            pen.rectangle([FINER * v for v in (left, row - 6, left + 12, row + 6)], fill=colour)
            _text(pen, (left + 17, row), name, 14, "lm")
            left += wide

    def _bar(self, pen: ImageDraw, left: float, wide: float, bar: Bar, parts: Mapping[str, Colour]) -> None:
        total = 0.0
        for value, colour in zip(bar, parts.values(), strict=True):
            if value:
                rows = self._row(total + value), self._row(total)
                pen.rectangle([FINER * v for v in (left + 1, rows[0], left + wide - 1, rows[1])], fill=colour)
                total += value
        if any(value is not None for value in bar):
            _text(pen, (left + 0.5 * wide, self._row(total) - 8), written(total), 11, "mm")


def written(value: float) -> str:
    """A value in two digits, or as many as a whole number has."""
    return f"{value:.0f}" if abs(value) >= 10.0 else f"{value:.2g}"


def tick(highest: float) -> float:
    """A round step, 1, 2 or 5 times a power of ten, of which about five reach ``highest``."""
    least = max(highest, 1e-9) / _TICKS
    power = 10.0 ** math.floor(math.log10(least))
    return next(step for step in (power, 2.0 * power, 5.0 * power, 10.0 * power) if step >= least * (1.0 - 1e-9))


def _text(pen: ImageDraw, place: tuple[float, float], text: str, size: int, anchor: str, colour: Colour = INK) -> None:
    from PIL import ImageFont

    font = ImageFont.load_default(FINER * size)
    pen.text((FINER * place[0], FINER * place[1]), text, fill=colour, font=font, anchor=anchor)


def _length(text: str, size: int) -> float:
    from PIL import ImageFont

    return float(ImageFont.load_default(FINER * size).getlength(text)) / FINER
