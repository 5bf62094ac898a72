"""How strong a descriptor of an EmotionML document is, over time: a value, or a trace.

Source: Emotion Markup Language 1.0, W3C Recommendation 22 May 2014, section 2.5, "Scale values".
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from agentface.conventions import ROUNDING, Doubles
from agentface.emotion.score import FASTEST_HZ, LONGEST_S
from agentface.io.emotionml_grammar import NAMESPACE, Grammar, shortened
from agentface.io.markup import Element
from agentface.io.report import Report

_NUMBER = re.compile(r"[-+]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_HERTZ = re.compile(r"(\d+(?:\.\d*)?)\s*Hz", re.ASCII)
_SLOWEST_HZ = 1e-6
_TOGETHER_HZ = 50.0
_MOST_TOGETHER = 10
"""Samples of traces made one, in parts of the samples that they have."""


@dataclass(frozen=True, slots=True)
class Curve:
    """Samples 0..1, ``(T,)``, and how many of them a second; 0 for a constant, which has one."""

    samples: Doubles
    rate_hz: float = 0.0

    @classmethod
    def constant(cls, level: float) -> Curve:
        """One level."""
        return cls(np.array([level]))

    @property
    def lasts_ms(self) -> float | None:
        """How long its samples last; None for a constant."""
        return 1000.0 * len(self.samples) / self.rate_hz if self.rate_hz else None


def together(curves: Sequence[Curve]) -> tuple[Doubles, float]:
    """The levels of several curves at the same times, ``(T, len(curves))``, and their rate; 0 where all are constant.

    Curves of one rate keep it and their samples. Others, and those faster than 50 Hz, are sampled anew, the last sample
    of the shorter ones holding.
    """
    moving = [curve for curve in curves if len(curve.samples) > 1]
    if not moving:
        return np.array([[curve.samples[0] for curve in curves]]), 0.0
    rate = min(max(curve.rate_hz for curve in moving), _TOGETHER_HZ)
    length_s = min(max((len(curve.samples) - 1) / curve.rate_hz for curve in moving), LONGEST_S)
    if all(curve.rate_hz == rate for curve in moving):
        count = max(len(curve.samples) for curve in moving)
    else:
        most = _MOST_TOGETHER * sum(len(curve.samples) for curve in moving)
        count = max(2, min(math.ceil(length_s * rate) + 1, most))
        rate = (count - 1) / length_s
    times = np.arange(count) / rate
    return np.column_stack(
        [np.interp(times, np.arange(len(curve.samples)) / (curve.rate_hz or 1.0), curve.samples) for curve in curves]
    ), rate


class CurveReader:
    """Reads the values and traces of one document."""

    def __init__(self, grammar: Grammar, report: Report) -> None:
        self._grammar, self._report = grammar, report

    def curve(self, element: Element, where: str) -> Curve | None:
        """The value or the trace of an element; None where it has neither, or none that can be read."""
        self._number(element, "confidence", where)
        traces = [child for child in element.children if (child.namespace, child.name) == (NAMESPACE, "trace")]
        value = self._number(element, "value", where)
        if not traces:
            return None if value is None else Curve.constant(value)
        if len(traces) > 1 or "value" in element.attributes:
            self._report.tell(traces[-1].line, where, "a value or one trace", "more than that")
        return self._trace(traces[0], f"{where}.trace")

    def _number(self, element: Element, attribute: str, where: str) -> float | None:
        text = element.attributes.get(attribute)
        return None if text is None else self._fraction(text, element.line, f"{where}.{attribute}")

    def _fraction(self, text: str, line: int, where: str) -> float | None:
        number = float(text) if _NUMBER.fullmatch(text.strip()) else -1.0
        if not -ROUNDING <= number <= 1.0 + ROUNDING:
            self._report.tell(line, where, "a number in 0..1", shortened(text))
            return None
        return min(max(number, 0.0), 1.0)

    def _trace(self, element: Element, where: str) -> Curve | None:
        self._grammar.children(element, where)
        said = element.attributes.get("freq", "nothing")
        rate = _HERTZ.fullmatch(said.strip())
        hertz = float(rate[1]) if rate else 0.0
        if not hertz > 0.0:
            self._report.tell(element.line, f"{where}.freq", "a number above 0 and Hz, like 10Hz", shortened(said))
        texts = element.attributes.get("samples", "").split()
        samples = [self._fraction(text, element.line, f"{where}.samples") for text in texts]
        if not samples:
            self._report.tell(element.line, f"{where}.samples", "at least one number", "none")
        values = np.array([sample for sample in samples if sample is not None])
        return _slow_enough(values, hertz) if len(values) and hertz > 0.0 else None


def _slow_enough(samples: Doubles, rate_hz: float) -> Curve:
    """A trace of at most ``FASTEST_HZ``, its last sample kept; a slower one than once in 11 days counts as that."""
    rate_hz = max(rate_hz, _SLOWEST_HZ)
    every = max(1, math.ceil(min(rate_hz / FASTEST_HZ, len(samples))))
    if every == 1:
        return Curve(samples, min(rate_hz, FASTEST_HZ))
    kept = samples[::every]
    if (len(samples) - 1) % every:
        kept = np.append(kept, samples[-1])
    return Curve(kept, min(rate_hz / every, FASTEST_HZ))
