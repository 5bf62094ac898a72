"""Six intensities in time over a mood, and the contractions that the rules make of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Literal, NamedTuple, TypeAlias

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.emotion.envelopes import Envelopes, default_envelopes
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.motion.braking import SHORTEST_S
from agentface.motion.conflicts import default_conflicts
from agentface.motion.course import LAG_S, LATE_S, TICK_S, Course, EmotionRules
from agentface.motion.intensities import Intensities, trace_in_numpy
from agentface.motion.modes import LONGEST_S, ModeMean, mean_in_numpy
from agentface.motion.pairs import Pairs, held_back_in_numpy
from agentface.motion.sides import Sides, to_sides_in_numpy
from agentface.parameters import MUSCLES, NAMES, indices_of

Hold: TypeAlias = float | Literal["own"] | None
"""Seconds for which an expression stays; ``own`` for the apex of its envelope, None for ever."""
TAKING_OVER = 0.6
"""Of the time until an emotion is there that has another one go, the part in which the intensities change."""


class EmotionChannel:
    """Six intensities, each at its own pace, over a mood, and the contractions that the rules make of them.

    Of these each side of the face makes its ``gains (COUNT,)``; by ``lags_s`` some parameters are late. Without
    ``envelopes`` and ``pairs``, those that come with agentface.

    Attributes:
        mood: what the intensities return to.
        reached: called whenever the contractions are where they go.
        apart: how much the two sides of a pair are out of step, 0, not at all, .. 1, as the lags say.
    """

    def __init__(
        self,
        rules: EmotionRules,
        gains: Floats | None = None,
        *,
        envelopes: Envelopes | None = None,
        pairs: Pairs | None = None,
        lags_s: Mapping[str, float] | None = None,
    ) -> None:
        self._envelopes = envelopes or default_envelopes()
        loops = _kernels() if rules.compiled else _IN_NUMPY
        self._to_sides = loops.to_sides
        self._intensities = Intensities(self._envelopes, loops.trace)
        modes = ModeMean(TICK_S, loops.mean)
        self._course = Course(rules, self._intensities, modes, pairs or default_conflicts().pairs, loops.held_back)
        self.mood = EmotionState()
        self.apart = 0.0
        self.reached: list[Callable[[], object]] = []
        self._now = 0.0
        self._shown = np.zeros(len(EMOTIONS), np.bool_)
        self._returns, self._next = np.full(len(EMOTIONS), math.inf), math.inf
        self._fades = np.full(len(EMOTIONS), math.nan)
        self._due = np.zeros(len(EMOTIONS))
        places = [(index, row) for row, muscle in enumerate(MUSCLES) for index in indices_of(muscle)]
        self.names = tuple(NAMES[index] for index, _ in places)
        self._sides = Sides(
            np.array([row for _, row in places], np.int32),
            np.array([(lags_s or {}).get(name, 0.0) for name in self.names]) / LATE_S,
            np.ones(len(places)) if gains is None else gains[[index for index, _ in places]].astype(np.float64),
        )

    @property
    def target(self) -> EmotionState:
        """Where the intensities go."""
        return EmotionState(self._intensities.target)

    @property
    def intensities(self) -> Doubles:
        """``(6,)``, those shown now."""
        values: Doubles = self._intensities.at(np.array([self._now]))[0][0]
        return values

    def change(self, intensities: Mapping[str, float], fade: float | None, hold: Hold) -> None:
        """Set some emotions, leave the others; with ``hold`` these return to the mood so long after the fade.

        ``intensities`` maps names of ``EMOTIONS`` to 0..1. Without a ``fade`` each goes at its own pace.
        """
        places = np.array([EMOTIONS.index(emotion) for emotion in intensities], np.intp)
        levels = np.array(list(intensities.values()), np.float64)
        self._shown[places] = levels > 0.0
        self._fades[places] = math.nan if fade is None else fade
        stays = self._envelopes.apex_s[places] if hold == "own" else math.inf if hold is None else hold
        arrives = self._now + self._seconds(places, levels)
        self._move(places, levels)
        self._returns[places] = arrives + stays
        self._next = float(self._returns.min())

    def change_mood(self, mood: EmotionState, fade: float | None = None) -> None:
        """Have another mood; what is not just now shown for itself goes there within ``fade`` seconds."""
        self.mood = mood
        self._return(~self._shown, self._envelopes.mood_s if fade is None else fade)

    def release(self, fade: float | None) -> None:
        """Let go of all six: back to the mood."""
        self._return(np.ones(len(EMOTIONS), np.bool_), math.nan if fade is None else fade)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        until = self._now + dt
        while self._next < until:
            self._now = max(self._next, self._now)
            self._course.advance(self._now)
            self._return(self._returns <= self._now, self._fades)
        self._now, moved = until, not self._course.settled
        self._course.advance(until)
        if moved and self._course.settled:
            for tell in self.reached:
                tell()

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """The contractions now."""
        shown = self._course.shown
        if shown is None:
            return False
        apart = 0.0 if self._course.settled else self.apart
        late = self._course.late if apart > 0.0 else shown
        self._to_sides(shown, late, apart, self._sides, values)
        return True

    def _return(self, which: np.ndarray, fades: float | Doubles) -> None:
        """Back to the mood, in so many seconds each, NaN for its own pace."""
        places = np.flatnonzero(which)
        self._fades[places] = np.broadcast_to(fades, len(EMOTIONS))[places]
        self._shown[places], self._returns[places] = False, math.inf
        self._next = float(self._returns.min())
        self._move(places, self.mood.array[places])

    def _move(self, places: np.ndarray, levels: Doubles) -> None:
        """Set out for ``levels``; what is on its way there already, and due earlier, keeps its way."""
        seconds, told = self._seconds(places, levels), ~np.isnan(self._fades[places])
        takes_over = self._course.takes_over(self._now, places, levels)
        # What comes of the intensities is late by the lag, and by the mean of modes where one takes over from another:
        # a fade that was told has room for both, and at one's own pace there is time.
        room = np.where(seconds > 0.0, np.maximum(seconds - LAG_S, SHORTEST_S), 0.0)
        due = self._now + room + (np.where(told, 0.0, LONGEST_S) if takes_over else 0.0)
        fades = np.where(told, TAKING_OVER * room, room) if takes_over else room
        sooner = told & (due < self._due[places]) | (seconds == 0.0) & (not self._course.settled)
        new = (levels != self._intensities.target[places]) | sooner
        if new.any():
            places, fades = places[new], fades[new]
            self._intensities.move(places, levels[new], fades, self._now)
            self._due[places] = due[new]
            self._course.turn(self._now, places[fades == 0.0], float(self._due.max()))

    def _seconds(self, places: np.ndarray, levels: Doubles) -> Doubles:
        """How long each takes to its level: the fade that it was told, or its own pace."""
        rises = levels >= self.intensities[places]
        own = np.where(rises, self._envelopes.onset_s[places], self._envelopes.offset_s[places])
        return np.where(np.isnan(self._fades[places]), own, self._fades[places])


class _Loops(NamedTuple):
    """What does the work."""

    trace: Callable[..., None]
    mean: Callable[..., None]
    held_back: Callable[..., None]
    to_sides: Callable[..., None]


_IN_NUMPY = _Loops(trace_in_numpy, mean_in_numpy, held_back_in_numpy, to_sides_in_numpy)


def _kernels() -> _Loops:
    from agentface.motion.intensities_compiled import trace
    from agentface.motion.modes_compiled import mean
    from agentface.motion.pairs_compiled import held_back
    from agentface.motion.sides_compiled import to_sides

    return _Loops(trace, mean, held_back, to_sides)
