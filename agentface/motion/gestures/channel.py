"""The channel of gestures: several at once, each on its own time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from agentface.conventions import Doubles
from agentface.errors import UnknownNameError
from agentface.motion.doing import Doing
from agentface.motion.gestures.gesture import GestureForm
from agentface.parameters import parameter

MOST = 8
"""So many go on at once; another one ends the oldest."""
LET_GO_S = 0.25
"""What a gesture takes to end that is replaced by the same one, or by too many."""
_MOVED = ("head_yaw", "head_pitch")


class _Playing:
    """A gesture that goes on: from ``start`` on, less and less once it was told to end."""

    def __init__(
        self, gesture: GestureForm, start: float, strength: float, lags: Sequence[float], length_s: float | None = None
    ) -> None:
        self.gesture, self.start, self.strength, self.lags = gesture, start, strength, lags
        self.pace = 1.0 if length_s is None else gesture.length_s / length_s
        self.over = start + gesture.length_s / self.pace + max(lags, default=0.0)
        self._ends, self._fade = math.inf, 1.0
        self.doing = Doing(begun=True)

    def end(self, now: float, fade: float) -> None:
        """Let go within ``fade`` seconds."""
        self.doing.end(whole=False)
        if now <= self.start or fade <= 0.0:
            self.over = now  # nothing of it was shown
        elif math.isinf(self._ends):
            self._ends, self._fade = now, fade
            self.over = min(self.over, now + fade)

    def part(self, now: float) -> float:
        """How much of it is shown."""
        if now <= self._ends:
            return self.strength
        u = min((now - self._ends) / self._fade, 1.0)
        return self.strength * (1.0 - u * u * u * (10.0 - 15.0 * u + 6.0 * u * u))


class GestureChannel:
    """What the gestures that go on make together.

    A contraction comes on top of what is there: it is wanted in full, with the gesture's level as weight, so that a
    muscle neither stops where another channel already has it nor is contracted twice. Angles and shares add up.

    Args:
        gestures: those that can be asked for.
        lags_s: by parameter, how much later than told it moves.
    """

    def __init__(self, gestures: Mapping[str, GestureForm], lags_s: Mapping[str, float] | None = None) -> None:
        self.gestures = dict(gestures)
        tracks = {track.name for gesture in gestures.values() for track in gesture.tracks}
        self.names = tuple(sorted(tracks, key=lambda name: parameter(name).index))
        self.lagging = False
        """Whether the two sides of a pair are apart; of gestures that begin later."""
        self._lags = dict(lags_s or {})
        self._places = {name: place for place, name in enumerate(self.names)}
        self._contracts = tuple(parameter(name).contracts for name in self.names)
        # what is wanted of what no gesture moves just now: contractions in full, at no weight, and nothing added
        self._idle = np.array([self._contracts, [not contracts for contracts in self._contracts]], np.float64)
        self._playing: list[_Playing] = []
        self._now = 0.0
        self._head = [0.0] * len(_MOVED)

    @property
    def now_s(self) -> float:
        """The seconds that have passed."""
        return self._now

    @property
    def playing(self) -> tuple[str, ...]:
        """The names of those that go on, the oldest first."""
        return tuple(each.gesture.name for each in self._playing if each.start <= self._now)

    def play(self, name: str, strength: float = 1.0, in_s: float = 0.0, length_s: float | None = None) -> Doing:
        """Begin a gesture ``in_s`` seconds from now, at ``strength`` 0..1; raises UnknownNameError.

        It takes ``length_s`` seconds, its own time when None. One of the same name that goes on then ends.
        """
        if name not in self.gestures:
            raise UnknownNameError("gesture", name, tuple(self.gestures))
        gesture = self.gestures[name]
        lags = [self._lags.get(track.name, 0.0) if self.lagging else 0.0 for track in gesture.tracks]
        asked = _Playing(gesture, self._now + in_s, strength, lags, length_s)
        self._playing.append(asked)
        self._playing.sort(key=lambda each: each.start)
        return asked.doing

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        before, self._now = self._now, self._now + dt
        if not self._playing:
            return
        for place, each in enumerate(self._playing):
            if before <= each.start < self._now:
                self._give_way(place, each)
        for each in self._playing:
            if each.over <= self._now:
                each.doing.end(whole=True)
        self._playing = [each for each in self._playing if each.over > self._now]

    def release(self, fade: float) -> None:
        """End all that go on, within ``fade`` seconds."""
        for each in self._playing:
            each.end(self._now, fade)

    @property
    def turning(self) -> bool:
        """Whether any gesture goes on."""
        return bool(self._playing)

    @property
    def head(self) -> Sequence[float]:
        """How far the gestures turn yaw and pitch of the head now, in radians, as :meth:`write` wrote it.

        Those that move the eyes themselves are left out.
        """
        return self._head

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """What all of them make together."""
        self._head = [0.0] * len(_MOVED)
        if not self._playing:
            return False
        levels: dict[int, float] = {}
        for each in self._playing:
            if each.start < self._now:
                self._add(each, levels)
        values[:], weights[:] = self._idle
        for place, level in levels.items():
            (weights if self._contracts[place] else values)[place] = level
        return True

    def _add(self, each: _Playing, levels: dict[int, float]) -> None:
        part, since = each.part(self._now), self._now - each.start
        for track, lag in zip(each.gesture.tracks, each.lags, strict=True):
            place, level = self._places[track.name], part * track.at(each.pace * (since - lag))
            before = levels.get(place, 0.0)
            if self._contracts[place]:
                levels[place] = 1.0 - (1.0 - before) * (1.0 - level)
            else:
                levels[place] = before + level
                if track.name in _MOVED and not each.gesture.moves_eyes:
                    self._head[_MOVED.index(track.name)] += level

    def _give_way(self, place: int, begun: _Playing) -> None:
        going = [each for each in self._playing[:place] if each.over > begun.start]
        for number, each in enumerate(reversed(going), start=1):
            if each.gesture.name == begun.gesture.name or number >= MOST:
                each.end(begun.start, LET_GO_S)
