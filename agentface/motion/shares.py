"""Which part of a parameter speech has, and which is left to what the face feels; compiled twin beside it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Indices

POWER = 8.0
"""The power of the mean that is nearly the smaller of two."""


class Shares(NamedTuple):
    """Who has which part of the parameters that speech moves or that give way to it."""

    said: Indices
    """``(N,)``, the place of each in a sample; that of the first one where speech does not move it."""
    moved: Doubles
    """``(N,)``, 1 where speech moves it, and else 0."""
    yields: Doubles
    """``(N, 3)``, how far it gives way to speaking, to rounding and to closure, 0..1."""
    rounds: Indices
    """The places in a sample of what rounds the lips."""
    closes: Indices
    """The places of what closes them."""
    jaw: int
    """The place of the jaw among the parameters."""


def share_in_numpy(sample: Doubles, shares: Shares, values: Doubles, weights: Doubles) -> None:
    """Write what a sample ``(P + 2,)`` wants into ``values`` and ``weights``, ``(N,)`` each."""
    said, tight, speaking = np.clip(sample[:-2], -1.0, 1.0), float(sample[-2]), min(max(float(sample[-1]), 0.0), 1.0)
    levels = speaking, _together(said[shares.rounds]), _together(said[shares.closes])
    widest = 1.0 / math.expm1(tight) if tight > 0.0 else math.inf
    offset = said[shares.said] * shares.moved
    offset[shares.jaw] = _smaller(float(offset[shares.jaw]), widest)
    keep = 1.0 - np.abs(offset)
    for place, level in enumerate(levels):
        keep *= 1.0 - level * shares.yields[:, place]
    keep[shares.jaw] = _smaller(float(keep[shares.jaw]), widest - float(offset[shares.jaw]))
    np.subtract(1.0, keep, out=weights)
    values[:] = offset
    np.divide(offset, weights, out=values, where=weights > 0.0)


def _together(levels: Doubles) -> float:
    """0..1, as much as any of some parameters, and more where several go together."""
    return 1.0 - float(np.prod(1.0 - np.maximum(levels, 0.0)))


def _smaller(one: float, other: float) -> float:
    """Nearly the smaller of two that are not negative, at most 8 % less, and without a corner."""
    if min(one, other) <= 0.0:
        return 0.0
    ratio = min(one, other) / max(one, other)
    return float(min(one, other) / (1.0 + ratio**POWER) ** (1.0 / POWER))
