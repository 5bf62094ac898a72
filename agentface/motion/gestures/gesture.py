"""One gesture: what each parameter does over its time."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from typing import Self

import numpy as np

from agentface.conventions import Doubles
from agentface.parameters import PARAMETERS

_TURNS = tuple(known.name for known in PARAMETERS if known.kind == "gaze")


@dataclass(frozen=True, slots=True)
class Track:
    """One parameter over time: a monotone cubic from key to key (Fritsch, Butland, SIAM J. Sci. Stat. Comp. 5, 1984).

    It has no kink in its speed, rests at both ends and at every turn, and never runs past a key. Before and after it
    is at 0.

    Attributes:
        name: of the parameter, its side last.
        times_s: of the keys, the first at 0.
        values: in the parameter's unit, 0 at both ends.
        slopes: their change a second.
    """

    name: str
    times_s: tuple[float, ...]
    values: tuple[float, ...]
    slopes: tuple[float, ...]

    @classmethod
    def of(cls, name: str, times_s: Doubles, values: Doubles) -> Self:
        """The track through the keys ``(K,)``."""
        slopes = np.zeros(len(times_s))
        steps = np.diff(times_s)
        secants = np.diff(values) / steps
        before, after = secants[:-1], secants[1:]
        first, second = 2.0 * steps[1:] + steps[:-1], steps[1:] + 2.0 * steps[:-1]
        onward = before * after > 0.0
        mean = (first + second) * before * after / np.where(onward, first * after + second * before, 1.0)
        slopes[1:-1] = np.where(onward, mean, 0.0)
        return cls(name, *(tuple(part.tolist()) for part in (times_s, values, slopes)))

    def at(self, time_s: float) -> float:
        """Its value at a time since the gesture began."""
        times = self.times_s
        place = bisect_right(times, time_s)
        if place in (0, len(times)):
            return 0.0
        step = times[place] - times[place - 1]
        u = (time_s - times[place - 1]) / step
        low, high = self.values[place - 1 : place + 1]
        leaving, arriving = self.slopes[place - 1 : place + 1]
        curved = step * u * (1.0 - u) * ((1.0 - u) * leaving - u * arriving)
        return low + (high - low) * (u * u * (3.0 - 2.0 * u)) + curved


@dataclass(frozen=True, slots=True)
class GestureForm:
    """A gesture as it stands in the table.

    Attributes:
        name: as it is asked for.
        description: what it says.
        tracks: one a parameter.
    """

    name: str
    description: str
    tracks: tuple[Track, ...]

    @property
    def length_s(self) -> float:
        """How long it takes."""
        return max((track.times_s[-1] for track in self.tracks), default=0.0)

    @property
    def moves_eyes(self) -> bool:
        """Whether it says itself where the eyes turn."""
        return any(track.name in _TURNS for track in self.tracks)
