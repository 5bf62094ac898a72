""":class:`Sound`: what is heard, as samples."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from math import gcd
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from agentface.errors import InvalidValueError

Samples: TypeAlias = npt.NDArray[np.int16]
SLOWEST_RATE_HZ, FASTEST_RATE_HZ = 4_000, 192_000
LONGEST_S = 3600.0
"""No sound is longer."""

FADE_S = 0.02
"""So long a sound fades out that is ended before its end: no click is heard."""


@dataclass(frozen=True, eq=False)
class Sound:
    """One channel of sound.

    Attributes:
        samples: ``(N,)`` int16, at most ``LONGEST_S`` seconds of them.
        rate_hz: samples a second, a whole number in 4000..192000.

    Raises InvalidValueError for anything else.
    """

    samples: Samples
    rate_hz: int

    def __post_init__(self) -> None:
        rate = self.rate_hz
        if isinstance(rate, bool) or not isinstance(rate, int) or not SLOWEST_RATE_HZ <= rate <= FASTEST_RATE_HZ:
            expected = f"a whole number of samples a second in {SLOWEST_RATE_HZ}..{FASTEST_RATE_HZ}"
            raise InvalidValueError("sound rate", expected, rate)
        samples = np.asarray(self.samples)
        if samples.ndim != 1 or samples.dtype != np.int16:
            got = f"{samples.dtype} of shape {samples.shape}"
            raise InvalidValueError("sound samples", "int16 of shape (N,)", got)
        if len(samples) > LONGEST_S * rate:
            raise InvalidValueError("sound", f"at most {LONGEST_S:g} s", f"{len(samples) / rate:.1f} s")
        samples = samples.copy()
        samples.flags.writeable = False
        object.__setattr__(self, "samples", samples)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Sound):
            return NotImplemented
        return self.rate_hz == other.rate_hz and np.array_equal(self.samples, other.samples)

    def __hash__(self) -> int:
        return hash((self.rate_hz, self.samples.tobytes()))

    @property
    def duration_s(self) -> float:
        """Seconds."""
        return len(self.samples) / self.rate_hz

    def part(self, first: int, count: int) -> Samples:
        """``count`` samples from that at ``first`` on; silence where there are none."""
        samples = np.zeros(count, np.int16)
        begin, end = max(first, 0), min(first + count, len(self.samples))
        if begin < end:
            samples[begin - first : end - first] = self.samples[begin:end]
        return samples

    def at_rate(self, rate_hz: int) -> Sound:
        """The same with so many samples a second."""
        if rate_hz == self.rate_hz or not len(self.samples):
            return Sound(self.samples, rate_hz)
        from scipy.signal import resample_poly

        common = gcd(rate_hz, self.rate_hz)
        samples = resample_poly(self.samples.astype(np.float64), rate_hz // common, self.rate_hz // common)
        return Sound(np.clip(np.round(samples), -32768, 32767).astype(np.int16), rate_hz)

    def until(self, end_s: float) -> Sound:
        """Its beginning, faded out within ``FADE_S`` before ``end_s`` seconds."""
        end = round(max(end_s, 0.0) * self.rate_hz)
        if end >= len(self.samples):
            return self
        samples = self.samples[:end].astype(np.float64)
        count = min(round(FADE_S * self.rate_hz), end)
        if count:
            samples[end - count :] *= np.linspace(1.0, 0.0, count)
        return Sound(samples.astype(np.int16), self.rate_hz)


def mixed(parts: Iterable[tuple[float, Sound]], rate_hz: int) -> Sound:
    """Sounds that begin at times in seconds, added up; what is later than ``LONGEST_S`` is left out."""
    placed = [(round(start_s * rate_hz), sound.at_rate(rate_hz).samples) for start_s, sound in parts]
    most = round(LONGEST_S * rate_hz)
    total = np.zeros(min(max((start + len(samples) for start, samples in placed), default=0), most), np.int32)
    for start, samples in placed:
        begin, end = max(start, 0), min(start + len(samples), len(total))
        if begin < end:
            total[begin:end] += samples[begin - start : end - start]
    return Sound(np.clip(total, -32768, 32767).astype(np.int16), rate_hz)
