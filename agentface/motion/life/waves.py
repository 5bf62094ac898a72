"""Slow movement without end: sums of waves whose periods never meet."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles

_WAVES = 4
"""Waves in each sum."""


class Band(NamedTuple):
    """One movement: how far it goes at most, and between how many waves a second it has its own."""

    reach: float
    hz: Sequence[float]


class Waves:
    """Movements ``(B,)``, each the sum of four waves of its band, with phases and periods drawn once.

    Slower waves are larger: what turns a head slowly turns it further. A movement never exceeds its reach, and it is
    a function of the time alone.
    """

    def __init__(self, bands: Sequence[Band], random: np.random.Generator) -> None:
        low, high = (np.array([band.hz[end] for band in bands])[:, None] for end in (0, 1))
        # one in each quarter of the band by its logarithm, so that no two beat slowly against each other
        steps = (np.arange(_WAVES) + random.random((len(bands), _WAVES))) / _WAVES
        hz = low * (high / low) ** steps
        self._speeds = 2.0 * np.pi * hz
        self._phases = 2.0 * np.pi * random.random(hz.shape)
        weights = hz**-0.5
        self._weights = np.array([[band.reach] for band in bands]) * weights / weights.sum(1, keepdims=True)
        self._angles = np.empty_like(hz)

    def follow(self, band: int, leader: int, lag_s: float) -> None:
        """Have a band do what another one does, ``lag_s`` seconds later, or earlier."""
        self._speeds[band], self._weights[band] = self._speeds[leader], self._weights[leader]
        self._phases[band] = self._phases[leader] - lag_s * self._speeds[leader]

    def at(self, time_s: float, out: Doubles) -> Doubles:
        """The movements ``(B,)`` at a time, written into ``out``."""
        angles = self._angles
        np.multiply(self._speeds, time_s, out=angles)
        angles += self._phases
        np.sin(angles, out=angles)
        angles *= self._weights
        return np.add.reduce(angles, axis=1, out=out)
