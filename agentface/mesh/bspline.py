"""Uniform cubic B-splines: closed round a loop, and clamped between two ends (Piegl and Tiller 1997, chapter 2)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles

DEGREE = 3
_Places = npt.NDArray[np.int64]


def closed(places: Doubles, count: int) -> tuple[_Places, Doubles]:
    """Which control points of a closed curve of ``count`` act at ``places``, and their weights, both ``(N, 4)``.

    The curve at the integer k lies nearest to control point k.
    """
    cell = np.floor(places)
    t = places - cell
    weights = np.stack([(1 - t) ** 3, 3 * t**3 - 6 * t**2 + 4, -3 * t**3 + 3 * t**2 + 3 * t + 1, t**3], axis=-1) / 6
    index = (cell.astype(np.int64)[..., None] + np.arange(-1, 3)) % count
    return index, weights


def clamped(places: Doubles, count: int) -> tuple[_Places, Doubles]:
    """As :func:`closed`, for an open curve over 0..1 that starts and ends at its first and last control point."""
    spans = count - DEGREE
    knots = np.concatenate([np.zeros(DEGREE), np.linspace(0.0, 1.0, spans + 1), np.ones(DEGREE)])
    span = np.clip(np.floor(places * spans).astype(np.int64), 0, spans - 1)
    at = span + DEGREE
    weights = np.zeros((*places.shape, DEGREE + 1))
    weights[..., 0] = 1.0
    for degree in range(1, DEGREE + 1):  # Cox and de Boor's recurrence
        saved = np.zeros(places.shape)
        for i in range(degree):
            right, left = knots[at + i + 1], knots[at + 1 - degree + i]
            part = weights[..., i] / (right - left)
            weights[..., i] = saved + (right - places) * part
            saved = (places - left) * part
        weights[..., degree] = saved
    return span[..., None] + np.arange(DEGREE + 1), weights


def greville(count: int) -> Doubles:
    """Where on 0..1 each control point of the clamped curve acts most."""
    knots = np.concatenate([np.zeros(DEGREE), np.linspace(0.0, 1.0, count - DEGREE + 1), np.ones(DEGREE)])
    return np.array([knots[i + 1 : i + 1 + DEGREE].mean() for i in range(count)])
