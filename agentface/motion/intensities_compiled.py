"""``intensities`` compiled."""

from __future__ import annotations

from agentface.conventions import Doubles
from agentface.kernel import kernel
from agentface.motion.intensities import Moves

_ALMOST = 1.0 - 1e-9


@kernel()
def trace(times: Doubles, moves: Moves, ramps: Doubles, values: Doubles, speeds: Doubles) -> None:
    """As ``trace_in_numpy`` of ``intensities``, with the same arguments."""
    knots = ramps.shape[1]
    length = 1.0 / (knots - 1)
    for number in range(len(times)):
        for place in range(len(moves.start)):
            elapsed = times[number] - moves.begun[place]
            u = min(max(elapsed / moves.travel[place], 0.0), 1.0)
            w = min(max(elapsed / moves.brake[place], 0.0), 1.0)
            if u > _ALMOST and w > _ALMOST:
                values[number, place], speeds[number, place] = moves.target[place], 0.0
                continue
            knot = min(int(u * (knots - 1)), knots - 2)
            part = u / length - knot
            value, slope = ramps[moves.ramp[place], knot]
            next_value, next_slope = ramps[moves.ramp[place], knot + 1]
            rise = (next_value - value) / length
            bend, twist = 3.0 * rise - 2.0 * slope - next_slope, slope + next_slope - 2.0 * rise
            path = value + length * part * (slope + part * (bend + part * twist))
            climb = slope + part * (2.0 * bend + 3.0 * part * twist)
            left = 1.0 - w
            distance, speed = moves.target[place] - moves.start[place], moves.speed[place]
            reached = moves.start[place] + distance * path + speed * moves.brake[place] * w * left**3 * (1.0 + 3.0 * w)
            values[number, place] = min(max(reached, 0.0), 1.0)
            speeds[number, place] = distance / moves.travel[place] * climb
            speeds[number, place] += speed * left * left * (1.0 + 2.0 * w - 15.0 * w * w)
