"""The channel that plays a performance, or a stream that comes frame by frame."""

from __future__ import annotations

import math

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.motion.doing import Doing
from agentface.motion.envelope import Envelope
from agentface.motion.performance import HOLD_S, LET_GO_S, Performance
from agentface.parameters import COUNT, HIGH, LOW, NAMES

_SPAN = (HIGH - LOW).astype(np.float64)
_NEAR_S = 1e-3
"""Over so long a speed is measured."""


class PerformanceChannel:
    """What it shows is what is played, and beside it a rest of what was shown before, which goes to nothing.

    So there is no jump and no kink when a performance replaces another, ends or is stopped half-way. With a fade of 0
    there is no rest, and the frames are hit exactly. A performance lets go within ``LET_GO_S`` after its last frame; of
    a stream, the last frame holds for ``HOLD_S`` first.
    """

    names = NAMES

    def __init__(self) -> None:
        self._performance: Performance | None = None
        self._doing: Doing | None = None
        self._time = 0.0
        self._held = math.inf
        self._wanted = np.zeros((2, COUNT))
        self._rest = Envelope(2 * COUNT, np.append(-_SPAN, -np.ones(COUNT)), np.append(_SPAN, np.ones(COUNT)))

    @property
    def playing(self) -> bool:
        """Whether anything is played, or has not let go yet."""
        return self._performance is not None or not self._rest.resting

    @property
    def time_s(self) -> float | None:
        """How far into its performance it is; None without one."""
        return self._time if self._performance is not None else None

    def play(self, performance: Performance, fade: float = 0.0, from_s: float = 0.0) -> Doing:
        """Play from ``from_s`` on, coming to it within ``fade`` seconds from what is shown now."""
        self._take_over(performance, math.inf, from_s, fade)
        self._doing = Doing(begun=True)
        return self._doing

    def show(self, values: Floats, weights: Floats, fade: float = 0.0) -> None:
        """Show one frame of a stream: ``(COUNT,)`` each, values within their ranges and weights 0..1."""
        frame = Performance(np.zeros(1), np.asarray(values)[None], np.asarray(weights)[None])
        self._take_over(frame, HOLD_S, 0.0, fade)

    def release(self, fade: float) -> None:
        """Stop, and let go within ``fade`` seconds."""
        if self.playing:
            self._take_over(None, math.inf, 0.0, fade)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        if self._performance is None:
            self._rest.advance(dt)
            return
        left = self._performance.duration_s - self._time if math.isinf(self._held) else self._held
        if dt > left + 1e-9:  # a frame at its end is still shown
            self._step(max(left, 0.0))
            self._end(whole=True)
            self._take_over(None, math.inf, 0.0, LET_GO_S)
            dt -= max(left, 0.0)
        self._step(dt)

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """What is played now, and how much of each parameter it moves."""
        if not self.playing:
            return False
        rest = self._rest.value.reshape(2, COUNT)
        np.add(self._wanted[0], rest[0], out=values)
        np.clip(self._wanted[1] + rest[1], 0.0, 1.0, out=weights)
        return True

    def _step(self, dt: float) -> None:
        self._time += dt
        self._held -= dt
        self._rest.advance(dt)
        if self._performance is not None:
            self._wanted[:] = self._performance.sample(self._time)

    def _end(self, *, whole: bool) -> None:
        if self._doing is not None:
            self._doing.end(whole=whole)
            self._doing = None

    def _take_over(self, performance: Performance | None, held: float, from_s: float, fade: float) -> None:
        self._end(whole=False)
        rest = self._rest.value.reshape(2, COUNT)
        shown = self._wanted + rest
        speed = self._speed(-_NEAR_S) + self._rest.velocity.reshape(2, COUNT)
        self._performance, self._held, self._time = performance, held, from_s
        if performance is None:
            self._wanted[0], self._wanted[1] = shown[0], 0.0
        else:
            self._wanted[:] = performance.sample(from_s)
        if fade == 0.0:
            self._rest.move(0.0, 0.0)
            return
        ahead = self._speed(_NEAR_S)
        unseen = shown[1] <= 0.0  # there only the weight comes up
        shown[0], speed[0] = np.where(unseen, self._wanted[0], shown[0]), np.where(unseen, ahead[0], speed[0])
        self._rest.glide((shown - self._wanted).ravel(), (speed - ahead).ravel(), fade)

    def _speed(self, near: float) -> Doubles:
        """The change a second of what is played, from now until ``near`` seconds on."""
        if self._performance is None:
            return np.zeros((2, COUNT))
        values, weights = self._performance.sample(np.array([self._time, self._time + near]))
        return np.stack([values[1] - values[0], weights[1] - weights[0]]) / near
