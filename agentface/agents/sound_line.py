""":class:`SoundLine`: sounds placed in time, taken away piece by piece."""

from __future__ import annotations

import numpy as np

from agentface.speech.sound import Samples, Sound


class SoundLine:
    """Sounds that begin at times in seconds, added up where they overlap.

    Args:
        rate_hz: samples a second of what is taken.
    """

    def __init__(self, rate_hz: int) -> None:
        self.rate_hz = Sound(np.zeros(0, np.int16), rate_hz).rate_hz
        self._parts: list[tuple[int, Samples]] = []

    def add(self, start_s: float, sound: Sound) -> None:
        """Place a sound."""
        self._parts.append((round(start_s * self.rate_hz), sound.at_rate(self.rate_hz).samples))

    def clear(self) -> None:
        """Forget all of them."""
        self._parts = []

    def take(self, first: int, last: int) -> Samples | None:
        """The samples from one place until before another, and forget what is before that; None where nothing is."""
        here = [(start, samples) for start, samples in self._parts if start < last and start + len(samples) > first]
        self._parts = [(start, samples) for start, samples in self._parts if start + len(samples) > last]
        if not here:
            return None
        total = np.zeros(last - first, np.int32)
        for start, samples in here:
            begin, end = max(start, first), min(start + len(samples), last)
            total[begin - first : end - first] += samples[begin - start : end - start]
        return np.clip(total, -32768, 32767).astype(np.int16)
