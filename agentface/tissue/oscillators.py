"""The muscles' own swing: each contraction a damped oscillator, stepped exactly at any frame rate.

The mass of tissue shows in its slow movements, and these are what the muscles move: Galerkin's projection of Eq. 4 on
each muscle's response gives one oscillator a muscle. Its contraction lags behind what is asked of it, overshoots a
little, and settles; the tissue is in equilibrium with it at every instant.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles

_SLOWEST = 1e-9
"""rad/s: critical damping swings as slowly as that, which is the same."""


class Oscillators(NamedTuple):
    """M oscillators: their undamped angular ``frequency (M,)`` rad/s and ``ratio (M,)`` of critical damping."""

    frequency: Doubles
    ratio: Doubles

    def step(self, place: Doubles, speed: Doubles, start: Doubles, end: Doubles, dt: float) -> tuple[Doubles, Doubles]:
        """Where oscillators are, and how fast, after ``dt`` s in which what they follow goes straight on.

        All ``(M,)``: ``place`` and ``speed`` before; ``start`` and ``end`` of what they follow.
        """
        if dt <= 0.0:
            return place, speed
        ratio = self.ratio
        slope = (end - start) / dt
        lag = 2.0 * ratio / self.frequency * slope
        off, rate = place - start + lag, speed - slope
        decay = ratio * self.frequency
        swing = np.maximum(self.frequency * np.sqrt(np.abs(ratio**2 - 1.0)), _SLOWEST)
        fades, angle = np.exp(-decay * dt), np.minimum(swing * dt, 700.0)
        under = ratio < 1.0
        even = np.where(under, np.cos(angle), np.cosh(angle))
        odd = np.where(under, np.sin(angle), np.sinh(angle)) / swing
        force = self.frequency**2 * off
        left = fades * (off * even + (rate + decay * off) * odd)
        moving = fades * (rate * even - (decay * rate + force) * odd)
        return end - lag + left, slope + moving
