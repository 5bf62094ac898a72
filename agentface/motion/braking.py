"""How a speed that a value has when a new move begins is taken over and braked away beside the move.

``w (1 - w)^3 (1 + 3 w)`` begins at 0 with speed 1 and ends at rest: of the family of the minimum-jerk path (Flash and
Hogan, J. Neuroscience 5, 1985).
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles

_PEAK = 0.2
"""The largest value of the braking curve is just below this."""
_OVERSHOOT = 0.1
"""How far, of the whole range, a value may run past its target when it is turned round in full motion."""
SHORTEST_S = 1e-6


def braking(w: Doubles) -> tuple[Doubles, Doubles]:
    """The curve and its speed at ``w`` in 0..1."""
    left = 1.0 - w
    return w * left**3 * (1.0 + 3.0 * w), left**2 * (1.0 + 2.0 * w - 15.0 * w * w)


def durations(
    start: Doubles,
    target: Doubles,
    speed: Doubles,
    fade: npt.ArrayLike,
    limits: tuple[npt.ArrayLike, npt.ArrayLike],
    steepest: npt.ArrayLike,
) -> tuple[Doubles, Doubles]:
    """The seconds of a move and those of its braking, each at most ``fade``.

    Two ways to take over a speed: shorten the move until it does not overshoot, or brake beside it and overshoot a
    little where the range leaves room. Each value takes the one that brakes more gently.

    Args:
        start: where each value is; ``target`` and ``speed`` likewise, all of one shape.
        target: where it goes.
        speed: its change a second.
        fade: seconds, one or one a value.
        limits: the range of the values.
        steepest: the path does not overshoot while its first speed is at most this times its mean speed.
    """
    low, high = (np.asarray(limit, np.float64) for limit in limits)
    ahead = (target - start) * np.sign(speed)
    furthest = np.where(speed > 0.0, high, -low)
    outermost = np.maximum(start * np.sign(speed), target * np.sign(speed))
    room = np.minimum(furthest - outermost, _OVERSHOOT * (high - low))
    quick = np.maximum(np.abs(speed), 1e-12)
    shortened = np.minimum(steepest * np.maximum(ahead, 0.0) / quick, fade)
    beside = np.minimum(np.maximum(room, 0.0) / (_PEAK * quick), fade)
    shorten = (ahead > 0.0) & (shortened >= beside)
    travel = np.where(shorten, shortened, fade)
    brake = np.where(shorten, shortened, beside)
    return np.maximum(travel, SHORTEST_S), np.maximum(brake, SHORTEST_S)


def steepest_start(slopes: Doubles) -> float:
    """How many times its mean speed a move may have at first and yet not turn back on its way.

    ``slopes`` are those of its path, a rise from 0 to 1, at even times.
    """
    speeds = braking(np.linspace(0.0, 1.0, len(slopes)))[1]
    back = speeds < 0.0
    return float((slopes[back] / -speeds[back]).min())
