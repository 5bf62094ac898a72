"""A :class:`Score`: emotions in time, as a document or a program wrote them down to be played."""

from __future__ import annotations

import math
from bisect import bisect_right
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from agentface.conventions import check_fraction, check_range
from agentface.emotion.state import EMOTIONS, NEUTRAL, EmotionState, canonical_or_neutral
from agentface.errors import Fault, InvalidValueError

FADE_S = 0.25
"""How long the face takes from one constant state to another."""
LONGEST_S = 3600.0
FASTEST_HZ = 10_000.0
_STEPS_PER_S = 20
_ROWS = (*EMOTIONS, NEUTRAL)
_AHEAD_S = 2 / _STEPS_PER_S
_FOLLOW_S = 3 / _STEPS_PER_S
"""Minimum-jerk moves of three steps, begun every step towards where a trace is two steps on, keep close to it."""


@dataclass(frozen=True, slots=True)
class Cue:
    """One emotion from ``start_s`` until just before ``end_s``: constant, or a trace of samples joined by lines.

    Attributes:
        emotion: one of ``EMOTIONS``, or ``neutral``, which leaves each of them at most 1 minus its own intensity.
        start_s: seconds, at least 0.
        end_s: seconds, later than the start, at most ``LONGEST_S``.
        samples: intensities 0..1, the first at the start; the last one holds until the end.
        rate_hz: samples a second, at most ``FASTEST_HZ``; 0 for one constant sample.

    Raises UnknownNameError for the emotion, InvalidValueError for what is not as said here.
    """

    emotion: str
    start_s: float
    end_s: float
    samples: tuple[float, ...] = (1.0,)
    rate_hz: float = 0.0

    def __post_init__(self) -> None:
        if canonical_or_neutral(self.emotion) != self.emotion:
            raise InvalidValueError("emotion", f"one of {', '.join(_ROWS)}", self.emotion)
        check_range("start_s", self.start_s, 0.0, LONGEST_S)
        if check_range("end_s", self.end_s, 0.0, LONGEST_S) <= self.start_s:
            raise InvalidValueError("end_s", f"more than the start, {self.start_s:g}", self.end_s)
        if not self.samples:
            raise InvalidValueError("samples", "at least one", self.samples)
        for sample in self.samples:
            check_fraction("sample", sample)
        if check_range("rate_hz", self.rate_hz, 0.0, FASTEST_HZ) == 0.0 and len(self.samples) > 1:
            raise InvalidValueError("rate_hz", "more than 0 for several samples", self.rate_hz)

    @property
    def moves_until_s(self) -> float:
        """When the last sample is reached; the start of a constant cue."""
        if len(self.samples) == 1:
            return self.start_s
        return min(self.end_s, self.start_s + (len(self.samples) - 1) / self.rate_hz)


@dataclass(frozen=True, slots=True)
class Change:
    """At ``time_s`` the face sets out for ``state``, which it reaches in ``fade_s`` seconds."""

    time_s: float
    state: EmotionState
    fade_s: float


class Score:
    """Cues in the order of their starts; where cues of one emotion overlap, the largest intensity counts.

    ``state`` is what the cues say, exactly. ``changes`` are the messages that make a face show it: a jump between
    constant states becomes a fade, a trace a chain of small moves. ``notes`` are the places of a document where the
    cues are not all that it says; where its last emotions show nothing, it lasts longer than they, ``lasts_s``.
    """

    def __init__(self, cues: Iterable[Cue] = (), notes: Iterable[Fault] = (), lasts_s: float = 0.0) -> None:
        self.cues = tuple(sorted(cues, key=lambda cue: (cue.start_s, cue.end_s, _ROWS.index(cue.emotion))))
        self.notes = tuple(notes)
        self.duration_s = max((cue.end_s for cue in self.cues), default=0.0)
        self.duration_s = max(self.duration_s, check_range("lasts_s", lasts_s, 0.0, LONGEST_S))
        counts = np.array([len(cue.samples) for cue in self.cues], np.intp)
        self._starts = np.array([cue.start_s for cue in self.cues])
        self._ends = np.array([cue.end_s for cue in self.cues])
        self._rates = np.array([cue.rate_hz for cue in self.cues])
        self._still = np.array([cue.moves_until_s for cue in self.cues])
        self._emotions = np.array([_ROWS.index(cue.emotion) for cue in self.cues], np.intp)
        self._samples = np.array([sample for cue in self.cues for sample in cue.samples])
        self._last = np.cumsum(counts) - 1
        self._first = self._last + 1 - counts

    @property
    def length_s(self) -> float:
        """Until the face is neutral again, which takes a fade after the last end; 0 for a score of no duration."""
        return self.duration_s + FADE_S if self.duration_s else 0.0

    @classmethod
    def sampled(cls, states: npt.ArrayLike, rate_hz: float) -> Score:
        """The score of states of the six, ``(T, 6)`` in the order of ``EMOTIONS``, that come ``rate_hz`` a second.

        Between two of them lies a line; the last holds for one step. Raises InvalidValueError for what is none.
        """
        levels = np.asarray(states, np.float64)
        if levels.ndim != 2 or levels.shape[1] != len(EMOTIONS) or not len(levels):
            raise InvalidValueError("states", f"an array of shape (T, {len(EMOTIONS)})", levels.shape)
        if check_range("rate_hz", rate_hz, 0.0, FASTEST_HZ) == 0.0:
            raise InvalidValueError("rate_hz", "more than 0", rate_hz)
        end_s = len(levels) / rate_hz
        shown = [(name, column) for name, column in zip(EMOTIONS, levels.T, strict=True) if np.any(column)]
        return cls((Cue(name, 0.0, end_s, tuple(column.tolist()), rate_hz) for name, column in shown), lasts_s=end_s)

    def state(self, time_s: float) -> EmotionState:
        """The intensities at a time in seconds."""
        return self._state(self._active(time_s), time_s)

    @cached_property
    def changes(self) -> tuple[Change, ...]:
        """What to tell the face, in the order of time; the first is at 0, and no two have the same time."""
        told: list[tuple[float, EmotionState, bool]] = []
        for time in self._times():
            active = self._active(time)
            follows = bool((time < self._still[active]).any())
            state = self._state(active, time + _AHEAD_S if follows else time)
            if not told or state != told[-1][1]:
                told.append((time, state, follows))
        nexts = [time for time, _, _ in told[1:]] + [math.inf]
        return tuple(
            Change(time, state, _FOLLOW_S if follows else min(FADE_S, after - time))
            for (time, state, follows), after in zip(told, nexts, strict=True)
        )

    def change(self, time_s: float) -> Change:
        """The last change at or before a time in seconds; the first one for a time before 0."""
        return self.changes[max(bisect_right(self.changes, time_s, key=lambda change: change.time_s) - 1, 0)]

    def _active(self, time_s: float) -> npt.NDArray[np.intp]:
        return np.flatnonzero((self._starts <= time_s) & (time_s < self._ends))

    def _state(self, active: npt.NDArray[np.intp], time_s: float) -> EmotionState:
        first, last = self._first[active], self._last[active]
        place = np.clip((time_s - self._starts[active]) * self._rates[active], 0.0, last - first)
        before = first + place.astype(np.intp)
        low, high = self._samples[before], self._samples[np.minimum(before + 1, last)]
        levels = np.zeros(len(_ROWS))
        np.maximum.at(levels, self._emotions[active], low + (place - np.floor(place)) * (high - low))
        levels = levels.clip(0.0, 1.0)
        return EmotionState(np.minimum(levels[:-1], 1.0 - levels[-1]))

    def _times(self) -> list[float]:
        """Where a state may begin: starts, ends, and the steps of what moves."""
        times = {0.0, *(time for cue in self.cues for time in (cue.start_s, cue.end_s))}
        step = 0
        for cue in self.cues:  # by their starts, so that a step is counted once
            if cue.moves_until_s > cue.start_s:
                step = max(step, math.ceil(cue.start_s * _STEPS_PER_S))
                until = math.ceil(cue.moves_until_s * _STEPS_PER_S) + 1
                times.update(number / _STEPS_PER_S for number in range(step, until))
                step = max(step, until)
        return sorted(times)
