"""What a timeline shows at one time; the numpy twin is :mod:`agentface.speech.coarticulation`."""

from __future__ import annotations

import math

from agentface.conventions import Doubles
from agentface.kernel import kernel
from agentface.speech.articulation import Ramps, Timeline
from agentface.speech.coarticulation import REACH_S


@kernel()
def sample(timeline: Timeline, ramps: Ramps, time: float, weights: Doubles, out: Doubles) -> None:
    """As its twin; ``weights (A,)`` is overwritten."""
    count, moved = out.shape[0] - 2, ramps.articulator.shape[0]
    weights[:] = 0.0
    out[:] = 0.0
    out[moved:count] = 1.0
    silent, tight = 1.0, 0.0
    for segment in range(timeline.spans.shape[0]):
        start, end = timeline.spans[segment]
        if end <= time - REACH_S or start >= time + REACH_S:
            continue
        _attract(timeline, ramps, segment, time, weights, out)
        for contact in range(count - moved):
            from_, to, before, after = timeline.held[segment, contact]
            level = timeline.targets[segment, moved + contact] * _bump(time, from_, to, before, after)
            out[moved + contact] *= 1.0 - level
        from_, to = timeline.kept[segment]
        tight += (timeline.tight[segment] * _bump(time, from_, to, ramps.jaw_s, ramps.jaw_s)) ** 3.0
        silent *= 1.0 - timeline.said[segment] * _bump(time, start, end, ramps.speaking[0], ramps.speaking[1])
    for place in range(moved):
        out[place] /= max(weights[ramps.articulator[place]], 1e-30)
    for place in range(moved, count):
        out[place] = 1.0 - out[place]
    out[count] = tight ** (1.0 / 3.0)
    out[count + 1] = 1.0 - silent


@kernel()
def _attract(timeline: Timeline, ramps: Ramps, segment: int, time: float, weights: Doubles, out: Doubles) -> None:
    """Add a segment's dominance to ``weights (A,)`` and what it makes of its targets to ``out``."""
    away = time - timeline.middles[segment, 0]
    far = max(abs(away) - timeline.middles[segment, 1], 0.0)
    distance = math.sqrt(far * far + ramps.round_s * ramps.round_s) - ramps.round_s
    side = 1 if away < 0.0 else 2
    place = 0
    for articulator in range(weights.shape[0]):
        strength = timeline.dominance[segment, articulator, 0]
        weight = strength * math.exp(-timeline.dominance[segment, articulator, side] * distance)
        weights[articulator] += weight
        while place < ramps.articulator.shape[0] and ramps.articulator[place] == articulator:
            out[place] += weight * timeline.targets[segment, place]
            place += 1


@kernel()
def _bump(time: float, start: float, end: float, before: float, after: float) -> float:
    """1 from ``start`` to ``end``, coming and going by half a cosine."""
    up, down = (time - start) / before + 1.0, (end - time) / after + 1.0
    if up <= 0.0 or down <= 0.0:
        return 0.0
    up, down = min(up, 1.0), min(down, 1.0)
    return (0.5 - 0.5 * math.cos(math.pi * up)) * (0.5 - 0.5 * math.cos(math.pi * down))
