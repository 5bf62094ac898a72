"""Values on their way from what is shown now to a target, each in its own time."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.kernel import can_compile
from agentface.motion.braking import durations
from agentface.motion.minimum_jerk import follow_in_numpy

_MONOTONE = 2.5
"""A minimum-jerk path does not overshoot while its first speed is at most this times its mean speed."""


class Envelope:
    """``size`` values that move smoothly: no jump, and no kink in the speed, even when turned round half-way.

    A move follows the minimum-jerk path ``10 u^3 - 15 u^4 + 6 u^5`` (Flash and Hogan, J. Neuroscience 5, 1985), which
    starts and ends at rest; the speed that a value has when a move begins is taken over and braked away by the path of
    the same family that begins and ends at 0. Values never leave ``low..high``, and end exactly on their target.

    Args:
        size: how many.
        low: their least, one or one a value; ``high`` likewise.
        compiled: whether a kernel takes them along their way; else numpy does.

    Attributes:
        value: ``(size,)`` float64, what is shown now.
        velocity: ``(size,)`` float64, its change a second.
        target: ``(size,)`` float64, where it goes.
    """

    def __init__(
        self, size: int, low: npt.ArrayLike = 0.0, high: npt.ArrayLike = 1.0, *, compiled: bool = False
    ) -> None:
        self.low: Doubles = np.array(np.broadcast_to(low, size), np.float64)
        self.high: Doubles = np.array(np.broadcast_to(high, size), np.float64)
        self.value, self.velocity, self.target = (np.zeros(size) for _ in range(3))
        self._start, self._speed = np.zeros(size), np.zeros(size)
        self._travel, self._brake, self._elapsed = np.ones(size), np.ones(size), np.ones(size)
        self._settled = self._resting = True
        self._follow: Callable[..., Any] = _kernel() if compiled and can_compile() else follow_in_numpy

    @property
    def settled(self) -> bool:
        """Whether every value is on its target."""
        return self._settled

    @property
    def resting(self) -> bool:
        """Whether every value is 0 and stays there."""
        return self._resting

    def move(self, target: npt.ArrayLike, fade: float, where: Any = slice(None)) -> None:
        """Send the values at ``where`` to ``target`` within ``fade`` seconds; 0 puts them there at once.

        A value that already is on its way to the same target, and due earlier, keeps its way: repeating a
        message does not hold the face back.
        """
        places = np.arange(len(self.value))[where]
        targets = np.broadcast_to(np.asarray(target, np.float64), places.shape)
        if fade > 0.0:
            remaining = np.maximum(self._travel, self._brake)[places] - self._elapsed[places]
            fresh = (targets != self.target[places]) | (remaining > fade)
            places, targets = places[fresh], targets[fresh]
        else:
            self.value[places], self.velocity[places] = targets, 0.0
        self.target[places] = targets
        self._start[places] = self.value[places]
        self._speed[places] = self.velocity[places]
        self._travel[places], self._brake[places] = durations(
            self._start[places],
            self.target[places],
            self._speed[places],
            fade,
            (self.low[places], self.high[places]),
            _MONOTONE,
        )
        self._elapsed[places] = 0.0
        self._settle((self.value == self.target).all() and not self.velocity.any())

    def glide(self, value: npt.ArrayLike, velocity: npt.ArrayLike, fade: float, target: npt.ArrayLike = 0.0) -> None:
        """Go to ``target`` within ``fade`` seconds from ``value``, kept in its range, which moves with ``velocity``."""
        self.value[:], self.velocity[:] = np.clip(value, self.low, self.high), velocity
        self.target[:] = np.nan  # no value is on its way there already
        self.move(target, fade)

    def advance(self, dt: float) -> Doubles:
        """Let ``dt`` seconds pass; returns ``value``."""
        if self._settled:
            return self.value
        self._elapsed += dt
        moves = self._start, self.target, self._speed, self._travel, self._brake, self._elapsed
        self._settle(self._follow(*moves, self.low, self.high, self.value, self.velocity))
        return self.value

    def _settle(self, there: Any) -> None:
        self._settled = bool(there)
        self._resting = self._settled and not self.target.any()


def _kernel() -> Callable[..., Any]:
    from agentface.motion.minimum_jerk_compiled import follow

    return follow
