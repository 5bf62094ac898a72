"""Six intensities on their way, each at its own pace and along its own ramp."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.emotion.envelopes import Envelopes
from agentface.emotion.ramps import KNOTS, cubic
from agentface.emotion.state import EMOTIONS
from agentface.motion.braking import braking, durations, steepest_start

_ALMOST = 1.0 - 1e-9
"""A move that is so far done is over: sums of frame times are not exact."""
_LEAST_STEEP = 0.5
"""Of a ramp that rests on its way."""


class Moves(NamedTuple):
    """The move that each intensity is on, ``(6,)`` each.

    From ``start`` to ``target``, begun at the time ``begun``, which takes ``travel`` seconds along the ramp number
    ``ramp``; the ``speed`` that it had at first is braked away in ``brake`` seconds.
    """

    start: Doubles
    target: Doubles
    speed: Doubles
    begun: Doubles
    travel: Doubles
    brake: Doubles
    ramp: npt.NDArray[np.int64]


class Intensities:
    """Intensities in 0..1 by a clock that is told: nothing is kept from one moment to the next.

    Args:
        envelopes: their ramps.
        trace: what follows them, ``trace_in_numpy`` or its compiled twin.
    """

    def __init__(self, envelopes: Envelopes, trace: Callable[..., None]) -> None:
        count = len(EMOTIONS)
        start, target, speed = np.zeros((3, count))
        travel, brake = np.ones((2, count))
        self._moves = Moves(start, target, speed, np.full(count, -1.0), travel, brake, np.zeros(count, np.int64))
        self._ramps = envelopes.ramps
        self._steepest = np.array([max(steepest_start(ramp[:, 1]), _LEAST_STEEP) for ramp in envelopes.ramps])
        self._trace = trace

    @property
    def target(self) -> Doubles:
        """``(6,)``, where they go."""
        return self._moves.target

    def at(self, times: Doubles) -> tuple[Doubles, Doubles]:
        """Values and speeds at times ``(N,)`` since the newest move began, ``(N, 6)`` each."""
        values, speeds = np.empty((2, len(times), len(EMOTIONS)))
        self._trace(times, self._moves, self._ramps, values, speeds)
        return values, speeds

    def move(self, places: npt.NDArray[np.intp], targets: Doubles, fades: Doubles, now: float) -> None:
        """Send those at ``places`` to ``targets`` within ``fades`` seconds, each its own; 0 puts one there at once."""
        moves = self._moves
        (values,), (speeds,) = self.at(np.array([now]))
        at_once = fades == 0.0
        moves.start[places] = np.where(at_once, targets, values[places])
        moves.speed[places] = np.where(at_once, 0.0, speeds[places])
        moves.target[places], moves.begun[places] = targets, now
        moves.ramp[places] = places + np.where(targets < moves.start[places], len(EMOTIONS), 0)
        moves.travel[places], moves.brake[places] = durations(
            moves.start[places],
            targets,
            moves.speed[places],
            fades,
            (0.0, 1.0),
            self._steepest[moves.ramp[places]],
        )


def trace_in_numpy(times: Doubles, moves: Moves, ramps: Doubles, values: Doubles, speeds: Doubles) -> None:
    """Write values and speeds at ``times (N,)``, ``(N, 6)`` each, along ``ramps (R, KNOTS, 2)``."""
    elapsed = times[:, None] - moves.begun
    u = np.clip(elapsed / moves.travel, 0.0, 1.0)
    w = np.clip(elapsed / moves.brake, 0.0, 1.0)
    knot = np.minimum((u * (KNOTS - 1)).astype(np.intp), KNOTS - 2)
    length = 1.0 / (KNOTS - 1)
    before, after = ramps[moves.ramp, knot], ramps[moves.ramp, knot + 1]
    path, slope = cubic(u / length - knot, length, before[..., 0], before[..., 1], after[..., 0], after[..., 1])
    braked, braked_speed = braking(w)
    distance = moves.target - moves.start
    there = (u > _ALMOST) & (w > _ALMOST)
    reached = moves.start + distance * path + moves.speed * moves.brake * braked
    values[:] = np.where(there, moves.target, np.clip(reached, 0.0, 1.0))
    speeds[:] = np.where(there, 0.0, distance / moves.travel * slope + moves.speed * braked_speed)
