""":class:`VoiceOutput`: what a face says, heard on the machine's device as it is shown."""

from __future__ import annotations

import threading
from collections.abc import Callable
from types import TracebackType
from typing import Self

from agentface.clock import Clock, SystemClock
from agentface.errors import SpeechError
from agentface.io.loudspeaker import BUFFER_S, Loudspeaker
from agentface.speech.sound import Sound
from agentface.talk.talker import Talker


class VoiceOutput:
    """Plays what ``talker`` says from its making until ``close``; the device is opened with the first sentence.

    That happens in a thread of its own, as it takes a while: a sentence that has begun by then is heard from there on.
    Without a device the face speaks silently, which ``told`` is told once.

    Args:
        talker: says what is heard.
        told: told in a line why nothing is heard.
        opened: opens the device; raises SpeechError.
        clock: the time in which the face lives.
    """

    def __init__(
        self,
        talker: Talker,
        told: Callable[[str], object],
        opened: Callable[[], Loudspeaker] = Loudspeaker,
        clock: Clock | None = None,
    ) -> None:
        self._talker, self._told, self._opened, self._clock = talker, told, opened, clock or SystemClock()
        self._lock = threading.Lock()
        self._speaker: Loudspeaker | None = None
        self._waiting: list[tuple[float, Sound]] = []
        self._opening: threading.Thread | None = None
        self._silent = False
        talker.latency_s = max(talker.latency_s, BUFFER_S)
        talker.heard.append(self._hear)
        talker.hushed.append(self._hush)

    def close(self) -> None:
        """Let go of the talker and the device; may be called twice."""
        if self._hear in self._talker.heard:
            self._talker.heard.remove(self._hear)
            self._talker.hushed.remove(self._hush)
            self._talker.latency_s = 0.0
        if self._opening is not None:
            self._opening.join()
        speaker, self._speaker, self._silent = self._speaker, None, True
        if speaker is not None:
            speaker.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _hear(self, sound: Sound, in_s: float) -> None:
        in_s += self._talker.latency_s - BUFFER_S  # others may hear it later than the device
        with self._lock:
            if self._silent:
                return
            if self._speaker is None:
                self._waiting.append((self._clock.now() + in_s, sound))
                if self._opening is None:
                    self._opening = threading.Thread(target=self._open, name="agentface-sound", daemon=True)
                    self._opening.start()
                return
            self._speaker.play(sound, in_s)

    def _hush(self) -> None:
        with self._lock:
            self._waiting.clear()
            if self._speaker is not None:
                self._speaker.hush()

    def _open(self) -> None:
        try:
            speaker = self._opened()
        except SpeechError as error:
            self._silent = True
            self._told(str(error))
            return
        with self._lock:
            self._speaker = speaker
            waiting, self._waiting = self._waiting, []
            for at, sound in waiting:
                speaker.play(sound, at - self._clock.now())
