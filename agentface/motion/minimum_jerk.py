"""Where values are on their minimum-jerk paths (Flash and Hogan, J. Neuroscience 5, 1985); compiled twin beside it."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles
from agentface.motion.braking import braking

ALMOST = 1.0 - 1e-9
"""A move that is so far done is over: sums of frame times are not exact."""


def follow_in_numpy(
    start: Doubles,
    target: Doubles,
    speed: Doubles,
    travel: Doubles,
    brake: Doubles,
    elapsed: Doubles,
    low: Doubles,
    high: Doubles,
    value: Doubles,
    velocity: Doubles,
) -> bool:
    """Write where moves are after so much time into ``value`` and ``velocity``; returns whether all are over.

    Args, ``(size,)`` each:
        start: where each begins, and ``target``, where it goes.
        speed: that it had, which is braked away.
        travel: its seconds, and ``brake``, those of the braking.
        elapsed: the seconds since it began.
        low: the least value, and ``high``, the greatest.
    """
    u, w = np.minimum(elapsed / travel, 1.0), np.minimum(elapsed / brake, 1.0)
    distance, square, left = target - start, u * u, 1.0 - u
    braked, braked_speed = braking(w)
    path = start + distance * (square * u * (10.0 - 15.0 * u + 6.0 * square)) + speed * brake * braked
    there = (u > ALMOST) & (w > ALMOST)
    value[:] = np.where(there, target, np.minimum(np.maximum(path, low), high))
    velocity[:] = np.where(there, 0.0, distance / travel * (30.0 * square * left * left) + speed * braked_speed)
    return bool(there.all())
