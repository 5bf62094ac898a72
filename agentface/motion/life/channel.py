"""The channel of life: what a face does between messages, as far as its liveliness goes."""

from __future__ import annotations

import heapq
import math
from collections.abc import Callable, Mapping, Sequence
from itertools import count

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.motion.blink import BlinkChannel
from agentface.motion.envelope import Envelope
from agentface.motion.figures import IDLE, SPEAKING, LifeTable, StateRow, drawn
from agentface.motion.gaze import GazeChannel
from agentface.motion.gestures.channel import GestureChannel
from agentface.motion.life.blinks import Blinks
from agentface.motion.life.breath import Breath
from agentface.motion.life.habits import Habits
from agentface.motion.life.saccades import Saccades
from agentface.motion.life.waves import Band, Waves

_PRESENCE, _MOVEMENT, _SWAY, _PUPILS = range(4)
_BEAT, _BEAT_BROWS = "beat", "beat_brows"
_WIDEST_SWAY = 4.0


class LifeChannel:
    """Glances, sway, breath and pupils; it also tells the channels of blinks and gestures when to move.

    All of it is a function of the channel's own time, the sum of the ``dt``: events stand at their own times, between
    frames, and each draws its random numbers when it happens. So the frames of any rate show the same motion.

    By ``lags_s`` one side of a pair is late.

    Attributes:
        liveliness: 0, perfectly still, .. 1.
        head: how far it turns yaw and pitch of the head now, in radians, as :meth:`write` wrote it.
    """

    names = (
        *("gaze_yaw", "gaze_pitch"),
        *("head_yaw", "head_pitch", "head_roll"),
        *(f"{name}_{side}" for name in ("nostril_flare", "pupil_dilation") for side in SIDES),
        "breath",
    )

    def __init__(
        self,
        table: LifeTable,
        random: np.random.Generator,
        gaze: GazeChannel,
        blink: BlinkChannel,
        gestures: GestureChannel,
        lags_s: Mapping[str, float],
        *,
        compiled: bool = False,
    ) -> None:
        self._table, self._gaze, self._blink, self._gestures = table, gaze, blink, gestures
        waves, blinks, saccades, breath, habits, self._beats = random.spawn(6)
        closer, nostrils, pupils = (
            tuple(lags_s.get(f"{name}_{side}", 0.0) for side in SIDES)
            for name in ("orbicularis_oculi_palpebralis", "nostril_flare", "pupil_dilation")
        )
        self._lids, self._nostrils = closer, nostrils
        self._waves = self._bands(waves, pupils[1] - pupils[0])
        self._moved = np.zeros(7)
        self._blinks = Blinks(table, blink, blinks)
        self._saccades = Saccades(table.saccades, saccades, compiled=compiled)
        self._breath = Breath(table.breathing, breath)
        self._habits = Habits(gestures, habits)
        self.liveliness = 0.0
        self.head: Sequence[float] = (0.0, 0.0)
        self._alive = False
        self._now, self._beaten, self._looks = 0.0, -math.inf, gaze.looks
        self._told: str | None = None
        self._speaks = False
        self._cues: list[tuple[float, int, Callable[[], None]]] = []
        self._numbers = count()
        low, high = [0.0, 0.0, 0.0, -1.0], [1.0, 1.0 / table.dial.natural, _WIDEST_SWAY, 1.0]
        self._levels = Envelope(4, low, high, compiled=compiled)
        self._levels.move([self._row.sway, self._row.pupils], 0.0, [_SWAY, _PUPILS])

    @property
    def presence(self) -> float:
        """Whether it lives, 0, not at all, .. 1; in between while that changes."""
        return float(self._levels.value[_PRESENCE])

    @property
    def state(self) -> str:
        """What the face is about: what it was told, or else speaking while it speaks, and idle."""
        return self._told or (SPEAKING if self._speaks else IDLE)

    @property
    def turning(self) -> bool:
        """Whether it may turn the head now."""
        return self._alive

    def set_liveliness(self, liveliness: float, fade: float | None = None) -> None:
        """Be as lively as 0..1 says, within ``fade`` seconds; the table's own when None."""
        if liveliness == self.liveliness:
            return
        natural = self._table.dial.natural
        fade = self._table.dial.fade_s if fade is None else fade
        self.liveliness = liveliness
        self._levels.move([float(liveliness > 0.0), liveliness / natural], fade, [_PRESENCE, _MOVEMENT])
        lively = liveliness > 0.0
        self._blink.lags_s = self._lids if lively else (0.0,) * len(SIDES)
        self._gestures.lagging = lively
        if lively and not self._alive:
            self._alive = True
            self._breath.happen(self._now)
        self._begin()

    def set_state(self, state: str | None) -> None:
        """Be about one of ``STATES``; None leaves it to whether the face speaks."""
        before, self._told = self.state, state
        self._go_over(before)

    def speaking(self, speaks: bool, in_s: float = 0.0) -> None:
        """Speech begins, or ends, ``in_s`` seconds from now.

        Here and below, "now" is the time to which this channel was advanced: a channel that tells it of what happens
        within a frame is advanced before it.
        """
        self._cue(in_s, lambda: self._speak(speaks))

    def beat(self, stress: float = 1.0, in_s: float = 0.0) -> None:
        """A word is stressed, ``stress`` 0..1, ``in_s`` seconds from now: a little nod, sometimes with the brows."""
        figures, random = self._table.beats, self._beats
        at = self._now + in_s
        if self.liveliness == 0.0 or at - self._beaten < figures.apart_s:
            return
        self._beaten = at
        size = stress * drawn(random, figures.strength) * self.liveliness / self._table.dial.natural
        name = _BEAT_BROWS if random.random() < figures.brows else _BEAT
        lowest = self._gestures.gestures[name].tracks[0].times_s[1]
        self._gestures.play(name, min(size, 1.0), max(0.0, at - lowest - self._gestures.now_s))

    def sentence_ends(self, in_s: float = 0.0) -> None:
        """A sentence ends, ``in_s`` seconds from now: often with a blink."""
        self._cue(in_s, self._end_sentence)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        end = self._now + dt
        if self._gaze.looks != self._looks:
            self._looks = self._gaze.looks
            if self.liveliness > 0.0:
                self._saccades.come_back(self._now)
        while (due := self._due()) <= end:
            self._pass_to(due)
            self._happen(due)
        self._pass_to(end)
        if self._alive and self.liveliness == 0.0 and self.presence == 0.0:
            self._alive = False
            self._saccades.rest()

    def release(self, fade: float) -> None:
        """Nothing: a neutral face lives on."""

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """Where all of it is now."""
        if not self._alive:
            self.head = (0.0, 0.0)
            return False
        presence, movement, sway, wider = self._levels.value.tolist()
        yaw, pitch, roll, drift_yaw, drift_pitch, left, right = self._waves.at(self._now, self._moved).tolist()
        figures = self._table.breathing
        full = self._breath.at(self._now)[0]
        air, other_air = (self._breath.at(self._now - lag)[1] for lag in self._nostrils)
        eyes, head = self._saccades.eyes.value.tolist(), self._saccades.head.value.tolist()
        moved = presence * movement
        nostrils = moved * figures.nostrils
        turned = moved * sway * yaw + presence * head[0]
        raised = moved * (sway * pitch + math.radians(figures.head_deg) * full) + presence * head[1]
        self.head = (turned, raised)
        values[:] = (
            presence * (eyes[0] + drift_yaw),
            presence * (eyes[1] + drift_pitch),
            turned,
            raised,
            moved * sway * roll,
            nostrils * air,
            nostrils * other_air,
            presence * (wider + movement * left),
            presence * (wider + movement * right),
            moved * figures.chest * full,
        )
        return True

    @property
    def _row(self) -> StateRow:
        return self._table.states[self.state]

    def _bands(self, random: np.random.Generator, lag: float) -> Waves:
        head, saccades, pupils = self._table.head, self._table.saccades, self._table.pupils
        drift = math.radians(saccades.drift_deg)
        sways = [Band(math.radians(deg), head.hz) for deg in (head.yaw_deg, head.pitch_deg, head.roll_deg)]
        drifts = [Band(drift, saccades.drift_hz)] * 2
        waves = Waves([*sways, *drifts, *[Band(pupils.waves, pupils.hz)] * 2], random)
        waves.follow(6, 5, lag)
        return waves

    def _go_over(self, before: str) -> None:
        if self.state == before:
            return
        self._levels.move([self._row.sway, self._row.pupils], self._table.dial.fade_s, [_SWAY, _PUPILS])
        self._begin()

    def _begin(self) -> None:
        """Plan all that comes by itself anew."""
        processes = (self._blinks, self._saccades, self._habits)
        if self.liveliness == 0.0:
            for process in processes:
                process.due_s = math.inf
            return
        often = min(1.0, self.liveliness / self._table.dial.natural)
        for process in processes:
            process.begin(self._now, self._row, often)

    def _cue(self, in_s: float, what: Callable[[], None]) -> None:
        heapq.heappush(self._cues, (self._now + max(0.0, in_s), next(self._numbers), what))

    def _due(self) -> float:
        cued = self._cues[0][0] if self._cues else math.inf
        if not self._alive:
            return cued
        return min(cued, self._blinks.due_s, self._saccades.due_s, self._breath.due_s, self._habits.due_s)

    def _happen(self, due: float) -> None:
        if self._cues and self._cues[0][0] <= due:
            heapq.heappop(self._cues)[2]()
        elif self._breath.due_s <= due:
            self._breath.happen(due)
        elif self._saccades.due_s <= due:
            self._blinks.shifted(due, self._saccades.happen(due))
        elif self._blinks.due_s <= due:
            self._blinks.happen(due)
        else:
            self._habits.happen(due, self.liveliness / self._table.dial.natural)

    def _pass_to(self, end: float) -> None:
        dt, self._now = end - self._now, end
        self._levels.advance(dt)
        self._saccades.advance(dt)

    def _speak(self, speaks: bool) -> None:
        before, self._speaks = self.state, speaks
        self._go_over(before)

    def _end_sentence(self) -> None:
        if self.liveliness > 0.0:
            self._blinks.sentence_ended(self._now)
