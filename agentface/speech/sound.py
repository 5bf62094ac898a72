""":class:`Sound`: what is heard, as samples."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from agentface.conventions import check_duration
from agentface.errors import InvalidValueError

Samples: TypeAlias = npt.NDArray[np.int16]
SLOWEST_RATE_HZ, FASTEST_RATE_HZ = 4_000, 192_000
LONGEST_S = 600.0
"""No sound is longer."""


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

    def after(self, silence_s: float) -> Sound:
        """The same with ``silence_s`` seconds of silence before it."""
        count = round(check_duration("silence_s", silence_s) * self.rate_hz)
        return Sound(np.concatenate([np.zeros(count, np.int16), self.samples]), self.rate_hz)
