"""An explanation as a picture: the sets of each emotion, and of each muscle the rules that fired and their outcome."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Bytes, Doubles
from agentface.emotion.explanation import Explanation, ModeOutcome, MuscleOutcome
from agentface.emotion.sets import (
    CONTRACTION_CENTRES,
    CONTRACTION_HALF_WIDTH,
    CONTRACTION_SETS,
    INTENSITY_SETS,
    contraction_membership,
    intensity_membership,
)

if TYPE_CHECKING:
    from PIL.ImageDraw import ImageDraw

_FINE = 2  # drawn so many times larger, and made small again: smooth lines
_COLUMNS = 3
_WIDTH, _GAP, _MARGIN = 440, 36, 28
_CURVE, _LINE = 104, 19
_PAPER, _INK, _FAINT, _AXIS = (255, 255, 255), (40, 40, 44), (120, 120, 126), (170, 170, 176)
_COLOURS = ((49, 104, 168), (30, 142, 134), (112, 140, 40), (200, 128, 20), (190, 60, 50))
"""Of the five sets, from the lowest to the highest."""
_PALE = (226, 230, 238)
_POINTS = np.linspace(0.0, 1.0, 401)  # every corner of a set is one of them
_NAME, _ROW, _BAR = 280, 22, 9


def aggregate(cuts: dict[str, float], points: Doubles) -> Doubles:
    """``(P,)``: the sets of contraction, each clipped at its cut 0..1 and joined by the maximum, at ``points (P,)``."""
    heights = np.array([cuts.get(name, 0.0) for name in CONTRACTION_SETS])
    return np.asarray(np.minimum(heights[:, None], contraction_membership(points)).max(axis=0))


def rule_plot(explanation: Explanation) -> Bytes:
    """The picture, ``(H, W, 3)`` uint8: a part for each mode, the heaviest first."""
    from PIL import Image

    width = 2 * _MARGIN + _COLUMNS * _WIDTH + (_COLUMNS - 1) * _GAP
    # laid out twice: first to see how high it is
    height = _Page(None).draw(explanation)
    image = Image.new("RGB", (_FINE * width, _FINE * height), _PAPER)
    from PIL import ImageDraw

    _Page(ImageDraw.Draw(image)).draw(explanation)
    return np.asarray(image.resize((width, height), Image.Resampling.LANCZOS))


class _Page:
    """Draws from the top down; ``to`` None only measures."""

    def __init__(self, to: ImageDraw | None) -> None:
        self._to = to

    def draw(self, explanation: Explanation) -> int:
        """Draw it; the height of the page in pixels."""
        state = [f"{name} {value:g}" for name, value in explanation.state.as_dict().items() if value > 0.0]
        self._text((_MARGIN, 20), ", ".join(state) or "neutral", 26)
        self._text(
            (_MARGIN, 56),
            "Each rule clips its set at its strength. The clipped sets, joined, are filled; the line through them is "
            "their centroid, and the contraction is (centroid - 0.25) / 0.5.",
            15,
            _FAINT,
        )
        names = [
            low if low == small else f"{low}, {small}"
            for low, small in zip(INTENSITY_SETS, CONTRACTION_SETS, strict=True)
        ]
        self._words((_MARGIN, 84), names, list(range(len(names))))
        top = 122
        for mode in explanation.modes:
            top = self._mode(mode, explanation, top)
        return self._outcome(explanation, top)

    def _mode(self, mode: ModeOutcome, explanation: Explanation, top: int) -> int:
        self._rule(top)
        self._text((_MARGIN, top + 12), f"{mode.name}, weight {mode.weight:.2f}", 21)
        self._text((_MARGIN, top + 40), mode.description, 15, _FAINT)
        top += 72
        for column, emotion in enumerate(mode.name.split("+")):
            self._intensity((self._left(column), top), emotion, explanation.state.as_dict()[emotion])
        top += _CURVE + 98
        moved = [outcome for outcome in mode.muscles if outcome.contraction > 0.0]
        for first in range(0, len(moved), _COLUMNS):
            row = moved[first : first + _COLUMNS]
            heights = [self._muscle((self._left(i), top), outcome, mode) for i, outcome in enumerate(row)]
            top += max(heights) + 22
        still = [outcome.muscle for outcome in mode.muscles if outcome.contraction == 0.0]
        return self._still(still, top) if still else top

    def _outcome(self, explanation: Explanation, top: int) -> int:
        """What the face gets: the mean of the modes by their weights."""
        self._rule(top)
        self._text((_MARGIN, top + 12), "What the face gets: the mean of the modes by their weights", 21)
        top += 54
        moved = [(muscle, value) for muscle, value in explanation.contractions.items() if value > 0.0]
        rows = -(-len(moved) // _COLUMNS)
        for number, (muscle, value) in enumerate(moved):
            left, line = self._left(number // rows), top + number % rows * _ROW
            self._text((left, line), muscle, 14)
            self._text((left + _NAME, line), f"{value:.2f}", 14)
            start, middle = left + _NAME + 40, line + 9
            length = _WIDTH - _NAME - 40
            self._line((start, middle), (start + length, middle), _PALE, _BAR)
            self._line((start, middle), (start + value * length, middle), _COLOURS[0], _BAR)
        return top + rows * _ROW + 20

    def _intensity(self, place: tuple[int, int], emotion: str, intensity: float) -> None:
        """The five sets of intensity, and how much ``intensity`` belongs to each."""
        left, top = place
        self._text(place, f"{emotion} {intensity:g}", 18)
        top += 32
        self._axis(left, top)
        members = np.array([intensity_membership(float(point)) for point in _POINTS]).T
        degrees = intensity_membership(intensity)
        for number, (curve, degree) in enumerate(zip(members, degrees, strict=True)):
            self._curve(left, top, _POINTS, curve, _COLOURS[number], 1.6 if degree > 0.0 else 1.0)
        self._line((left + intensity * _WIDTH, top), (left + intensity * _WIDTH, top + _CURVE), _INK, 1.5)
        for number, degree in enumerate(degrees):
            if degree > 0.0:
                self._dot((left + intensity * _WIDTH, top + (1.0 - degree) * _CURVE), _COLOURS[number])
        said = [f"{name} {degree:.2f}" for name, degree in zip(INTENSITY_SETS, degrees, strict=True) if degree > 0.0]
        self._words((left, top + _CURVE + 22), said, [int(i) for i in np.flatnonzero(degrees)])

    def _muscle(self, place: tuple[int, int], outcome: MuscleOutcome, mode: ModeOutcome) -> int:
        """The sets of contraction as its rules clip them, and the rules; the height of both."""
        left, top = place
        self._text(place, f"{outcome.muscle}  {outcome.contraction:.2f}", 18)
        top += 32
        self._fill(left, top, _POINTS, aggregate(outcome.cuts, _POINTS))
        self._axis(left, top)
        for number, curve in enumerate(contraction_membership(_POINTS)):
            cut = outcome.cuts.get(CONTRACTION_SETS[number], 0.0)
            self._curve(left, top, _POINTS, curve, _COLOURS[number], 1.0)
            if cut > 0.0:
                reach = CONTRACTION_HALF_WIDTH * (1.0 - cut)
                ends = [left + (CONTRACTION_CENTRES[number] + side * reach) * _WIDTH for side in (-1.0, 1.0)]
                self._line(
                    (ends[0], top + (1 - cut) * _CURVE), (ends[1], top + (1 - cut) * _CURVE), _COLOURS[number], 3
                )
        self._curve(left, top, _POINTS, aggregate(outcome.cuts, _POINTS), _INK, 1.6)
        middle = left + outcome.centroid * _WIDTH
        self._line((middle, top), (middle, top + _CURVE), _INK, 1.5)
        top += _CURVE + 22
        rules = sorted((rule for rule in mode.rules if rule.muscle == outcome.muscle), key=lambda rule: -rule.strength)
        for rule in rules:
            premise = " and ".join(f"{emotion} {name}" for emotion, name in rule.premise)
            number = CONTRACTION_SETS.index(rule.consequent)
            self._text((left, top), f"{rule.strength:.2f}", 14, _COLOURS[number])
            self._text((left + 40, top), f"{premise}: {rule.consequent}", 14)
            top += _LINE
        return top - place[1]

    def _still(self, muscles: list[str], top: int) -> int:
        """The muscles that get nothing, in lines of the page's width."""
        self._text((_MARGIN, top), "no contraction:", 14, _FAINT)
        line, words = "", []
        for muscle in muscles:
            longer = f"{line}, {muscle}" if line else muscle
            if self._length(longer, 14) > _COLUMNS * _WIDTH - 80:
                words.append(f"{line},")
                longer = muscle
            line = longer
        for row in [*words, line]:
            self._text((_MARGIN + 110, top), row, 14, _FAINT)
            top += _LINE
        return top + 20

    def _words(self, place: tuple[int, int], words: list[str], numbers: list[int]) -> None:
        left = place[0]
        for word, number in zip(words, numbers, strict=True):
            self._text((left, place[1]), word, 14, _COLOURS[number])
            left += round(self._length(word, 14)) + 18

    @staticmethod
    def _left(column: int) -> int:
        return _MARGIN + column * (_WIDTH + _GAP)

    def _rule(self, top: int) -> None:
        self._line((_MARGIN, top), (_MARGIN + _COLUMNS * _WIDTH + (_COLUMNS - 1) * _GAP, top), _AXIS, 1.0)

    def _axis(self, left: int, top: int) -> None:
        self._line((left, top + _CURVE), (left + _WIDTH, top + _CURVE), _AXIS, 1.0)
        for tick in (0.0, 0.25, 0.5, 0.75, 1.0):
            x = left + tick * _WIDTH
            self._line((x, top + _CURVE), (x, top + _CURVE + 4), _AXIS, 1.0)
            text = f"{tick:g}"
            start = x - (0 if tick == 0.0 else self._length(text, 11) / (1 if tick == 1.0 else 2))
            self._text((start, top + _CURVE + 5), text, 11, _FAINT)

    def _curve(
        self, left: int, top: int, points: Doubles, heights: Doubles, colour: tuple[int, int, int], width: float
    ) -> None:
        above = np.flatnonzero(heights)
        if self._to is not None and len(above):
            part = slice(max(above[0] - 1, 0), above[-1] + 2)  # and no line along the axis
            places = self._places(left, top, points[part], heights[part])
            self._to.line(places, colour, round(_FINE * width), joint="curve")

    def _fill(self, left: int, top: int, points: Doubles, heights: Doubles) -> None:
        if self._to is not None:
            ends = self._places(left, top, points[[-1, 0]], np.zeros(2))
            self._to.polygon([*self._places(left, top, points, heights), *ends], _PALE)

    def _places(self, left: int, top: int, points: Doubles, heights: Doubles) -> list[tuple[float, float]]:
        x, y = left + points * _WIDTH, top + (1.0 - heights) * _CURVE
        return [(_FINE * float(a), _FINE * float(b)) for a, b in zip(x, y, strict=True)]

    def _line(
        self, start: tuple[float, float], end: tuple[float, float], colour: tuple[int, int, int], width: float
    ) -> None:
        if self._to is not None:
            self._to.line([_FINE * value for value in (*start, *end)], colour, round(_FINE * width))

    def _dot(self, place: tuple[float, float], colour: tuple[int, int, int]) -> None:
        if self._to is not None:
            x, y = (_FINE * value for value in place)
            self._to.ellipse((x - 8, y - 8, x + 8, y + 8), colour, _PAPER, 2)

    def _text(self, place: tuple[float, float], text: str, size: int, colour: tuple[int, int, int] = _INK) -> None:
        if self._to is not None:
            x, y = place
            self._to.text((_FINE * x, _FINE * y), text, fill=colour, font=_font(size))

    @staticmethod
    def _length(text: str, size: int) -> float:
        return float(_font(size).getlength(text)) / _FINE


def _font(size: int):  # type: ignore[no-untyped-def]
    from PIL import ImageFont

    return ImageFont.load_default(_FINE * size)
