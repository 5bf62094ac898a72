"""The way from one intensity to another: exponential ramps, and tables of times and levels, as curves without corners.

A ramp goes from 0 at time 0 to 1 at time 1, never backwards, and begins and ends at rest. It is kept as values and
slopes at ``KNOTS`` even times, between which it is a cubic.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from agentface.conventions import Doubles

KNOTS = 65
ROUNDED = 0.2
"""So much of an exponential ramp, at either end, is rounded off."""


def exponential_onset() -> Doubles:
    """``exp(ln 2 t) - 1``, rounded off at both ends: values and slopes, ``(KNOTS, 2)``.

    Source: Essa and Pentland, PAMI 19 (1997), as Bui (thesis, 2004) has it.
    """
    start, end = ROUNDED, 1.0 - ROUNDED
    ramp = np.empty((KNOTS, 2))
    for row, time in zip(ramp, np.linspace(0.0, 1.0, KNOTS), strict=True):
        if time < start:
            row[:] = _quintic(time, (0.0, start), ((0.0, 0.0, 0.0), _exponential(start)))
        elif time > end:
            row[:] = _quintic(time, (end, 1.0), (_exponential(end), (1.0, 0.0, 0.0)))
        else:
            row[:] = _exponential(time)[:2]
    return _exact(ramp)


def exponential_offset() -> Doubles:
    """How far ``exp(ln 2 - ln 2 t) - 1`` has come down: the onset back in time, likewise ``(KNOTS, 2)``."""
    onset = exponential_onset()[::-1]
    return np.stack([1.0 - onset[:, 0], onset[:, 1]], axis=1)


def through(points: Sequence[tuple[float, float]]) -> Doubles:
    """The smooth curve through times and levels that rise from (0, 0) to (1, 1), ``(KNOTS, 2)``.

    Source: Fritsch and Carlson, SIAM J. Numerical Analysis 17 (1980); at both ends at rest.
    """
    times, levels = np.array(points, np.float64).T
    lengths = np.diff(times)
    rises = np.diff(levels) / lengths
    slopes = np.zeros(len(times))
    for knot in range(1, len(times) - 1):
        before, after = rises[knot - 1], rises[knot]
        if before > 0.0 and after > 0.0:
            long, short = 2.0 * lengths[knot] + lengths[knot - 1], lengths[knot] + 2.0 * lengths[knot - 1]
            slopes[knot] = (long + short) * before * after / (long * after + short * before)
    at = np.linspace(0.0, 1.0, KNOTS)
    part = np.clip(np.searchsorted(times, at, "right") - 1, 0, len(lengths) - 1)
    length = lengths[part]
    knots = np.stack([levels[part], slopes[part], levels[part + 1], slopes[part + 1]])
    return _exact(np.stack(cubic((at - times[part]) / length, length, *knots), axis=1))


def cubic(
    u: Doubles, length: Doubles | float, value: Doubles, slope: Doubles, next_value: Doubles, next_slope: Doubles
) -> tuple[Doubles, Doubles]:
    """Value and slope at a share ``u`` of the way between two knots that are ``length`` apart (Hermite's cubic)."""
    rise = (next_value - value) / length
    bend, twist = 3.0 * rise - 2.0 * slope - next_slope, slope + next_slope - 2.0 * rise
    return (
        value + length * u * (slope + u * (bend + u * twist)),
        slope + u * (2.0 * bend + 3.0 * u * twist),
    )


def _exact(ramp: Doubles) -> Doubles:
    """The ramp without what rounding has left at its ends."""
    ramp[0], ramp[-1] = (0.0, 0.0), (1.0, 0.0)
    return ramp


def _exponential(time: float) -> tuple[float, float, float]:
    rate, grown = math.log(2.0), 2.0**time
    return grown - 1.0, rate * grown, rate * rate * grown


def _quintic(
    time: float, span: tuple[float, float], ends: tuple[tuple[float, float, float], tuple[float, float, float]]
) -> tuple[float, float]:
    """Value and slope of the quintic with the values, speeds and accelerations of ``ends`` at the ends of ``span``."""
    rows = [
        [math.perm(power, order) * (at - span[0]) ** max(power - order, 0) for power in range(6)]
        for at in span
        for order in range(3)
    ]
    found = np.linalg.solve(rows, np.ravel(ends))
    powers = (time - span[0]) ** np.arange(6.0)
    return float(found @ powers), float((found[1:] * np.arange(1.0, 6.0)) @ powers[:-1])
