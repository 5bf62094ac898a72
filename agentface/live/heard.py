"""What a face was heard to say while it ran, for a film that is drawn later."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from agentface.face import Face
from agentface.live.notes import Recorder
from agentface.speech.sound import Sound, mixed


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
