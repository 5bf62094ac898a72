"""``minimum_jerk`` compiled."""

from __future__ import annotations

from agentface.conventions import Doubles
from agentface.kernel import kernel
from agentface.motion.minimum_jerk import ALMOST


@kernel()
def follow(
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
    """As ``follow_in_numpy`` of ``minimum_jerk``, with the same arguments."""
    settled = True
    for place in range(len(value)):
        u, w = min(elapsed[place] / travel[place], 1.0), min(elapsed[place] / brake[place], 1.0)
        if u > ALMOST and w > ALMOST:
            value[place], velocity[place] = target[place], 0.0
            continue
        settled = False
        distance, square, left = target[place] - start[place], u * u, 1.0 - u
        path = start[place] + distance * (square * u * (10.0 - 15.0 * u + 6.0 * square))
        path += speed[place] * brake[place] * (w * (1.0 - w) ** 3 * (1.0 + 3.0 * w))
        value[place] = min(max(path, low[place]), high[place])
        velocity[place] = distance / travel[place] * (30.0 * square * left * left)
        velocity[place] += speed[place] * ((1.0 - w) ** 2 * (1.0 + 2.0 * w - 15.0 * w * w))
    return settled
