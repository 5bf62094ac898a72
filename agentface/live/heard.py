"""What a face is heard to say while it runs, for a film that is drawn meanwhile or later."""

from __future__ import annotations

from functools import cached_property
from threading import Lock
from types import TracebackType
from typing import Self

import numpy as np

from agentface.face import Face
from agentface.live.loop import Frame
from agentface.live.notes import Recorder
from agentface.speech.sound import SLOWEST_RATE_HZ, Samples, Sound, mixed


class HeardRecorder:
    """Keeps what ``face`` says, in a ``with`` block in which ``recorder`` writes down what it is asked.

    What is asked between two frames is asked again at the nearer one of the film's ``fps`` a second: so it is heard.
    """

    def __init__(self, face: Face, recorder: Recorder, fps: float) -> None:
        self._talker, self._recorder, self._fps = face.talker, recorder, fps
        self._parts: list[tuple[float, Sound]] = []

    def sound(self, rate_hz: int) -> Sound | None:
        """All of it, from the start of the loop on; None where nothing was said."""
        return mixed(self._parts, rate_hz) if self._parts else None

    def __enter__(self) -> Self:
        self._talker.heard.append(self._hear)
        self._talker.hushed.append(self._hush)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._talker.heard.remove(self._hear)
        self._talker.hushed.remove(self._hush)

    @property
    def _now(self) -> float:
        return round((self._recorder.last_s or 0.0) * self._fps) / self._fps

    def _hear(self, sound: Sound, in_s: float) -> None:
        self._parts.append((self._now + in_s + self._talker.latency_s, sound))

    def _hush(self) -> None:
        self._parts = [(start, sound.until(self._now - start)) for start, sound in self._parts if start < self._now]


class _Part:
    """A sentence that is heard from ``start_s`` on, at the film's rate as soon as somebody asks for it."""

    def __init__(self, start_s: float, spoken: Sound, rate_hz: int) -> None:
        self.start_s, self.spoken, self._rate_hz = start_s, spoken, rate_hz

    @cached_property
    def sound(self) -> Sound:
        """What is heard."""
        return self.spoken.at_rate(self._rate_hz)

    @property
    def end_s(self) -> float:
        """When it is over."""
        return self.start_s + self.spoken.duration_s


class LiveSound:
    """What ``face`` says in a ``with`` block, as the sound of a film that is drawn meanwhile; a sink of its loop.

    :meth:`part` may be called from another thread.
    """

    def __init__(self, face: Face, rate_hz: int) -> None:
        self.rate_hz = rate_hz
        self._talker = face.talker
        self._parts: list[_Part] = []
        self._changing = Lock()
        Sound(np.zeros(1, np.int16), SLOWEST_RATE_HZ).at_rate(rate_hz)  # what that loads, the loop would wait for later
        self._ahead_s = -self._talker.now_s
        """How much later the loop's time is than the talker's."""

    def show(self, frame: Frame) -> None:
        """Note the time."""
        self._ahead_s = frame.time_s - self._talker.now_s

    def part(self, first: int, count: int) -> Samples:
        """``count`` samples from that at ``first`` on, each to be asked for once."""
        with self._changing:
            self._parts = [part for part in self._parts if part.end_s * self.rate_hz > first]
            parts = tuple(self._parts)
        total = np.zeros(count, np.int32)
        for part in parts:
            total += part.sound.part(first - round(part.start_s * self.rate_hz), count)
        return np.clip(total, -32768, 32767).astype(np.int16)

    def __enter__(self) -> Self:
        self._talker.heard.append(self._hear)
        self._talker.hushed.append(self._hush)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._talker.heard.remove(self._hear)
        self._talker.hushed.remove(self._hush)

    @property
    def _now(self) -> float:
        return self._talker.now_s + self._ahead_s

    def _hear(self, sound: Sound, in_s: float) -> None:
        with self._changing:
            self._parts.append(_Part(self._now + in_s + self._talker.latency_s, sound, self.rate_hz))

    def _hush(self) -> None:
        now = self._now
        with self._changing:
            self._parts = [
                _Part(part.start_s, part.spoken.until(now - part.start_s), self.rate_hz)
                for part in self._parts
                if part.start_s < now
            ]
