"""``shares`` compiled."""

from __future__ import annotations

import math

from agentface.conventions import Doubles, Indices
from agentface.kernel import kernel
from agentface.motion.shares import POWER, Shares


@kernel()
def share(sample: Doubles, shares: Shares, values: Doubles, weights: Doubles) -> None:
    """As ``share_in_numpy`` of ``shares``, with the same arguments."""
    tight, speaking = sample[-2], min(max(sample[-1], 0.0), 1.0)
    rounding, closure = _together(sample, shares.rounds), _together(sample, shares.closes)
    widest = 1.0 / math.expm1(tight) if tight > 0.0 else math.inf
    for place in range(len(values)):
        offset = min(max(sample[shares.said[place]], -1.0), 1.0) * shares.moved[place]
        if place == shares.jaw:
            offset = _smaller(offset, widest)
        keep = 1.0 - abs(offset)
        keep *= 1.0 - speaking * shares.yields[place, 0]
        keep *= 1.0 - rounding * shares.yields[place, 1]
        keep *= 1.0 - closure * shares.yields[place, 2]
        if place == shares.jaw:
            keep = _smaller(keep, widest - offset)
        weights[place] = 1.0 - keep
        values[place] = offset / weights[place] if weights[place] > 0.0 else offset


@kernel()
def _together(sample: Doubles, places: Indices) -> float:
    left = 1.0
    for place in places:
        left *= 1.0 - min(max(sample[place], 0.0), 1.0)
    return 1.0 - left


@kernel()
def _smaller(one: float, other: float) -> float:
    if min(one, other) <= 0.0:
        return 0.0
    ratio = min(one, other) / max(one, other)
    return float(min(one, other) / (1.0 + ratio**POWER) ** (1.0 / POWER))
