"""What is said, on the machine's sound device."""

from __future__ import annotations

import os
import threading
from collections.abc import Generator, Iterator
from contextlib import contextmanager, suppress
from types import TracebackType
from typing import Any, Self

import numpy as np

from agentface.conventions import check_finite
from agentface.errors import SpeechError
from agentface.speech.sound import FADE_S, Samples, Sound

_RATE_HZ = 48_000
BUFFER_S = 0.06
"""About so much later than it is played a sound is heard."""
_NO_MINIAUDIO = """expected the Python package miniaudio, got none; what is said is not heard.
Install the extra that has it:  pip install "agentface[sound]\""""
_NO_DEVICE = "expected a sound device, got none; what is said is not heard ({reason})"


class Loudspeaker:
    """Plays sounds on the machine's usual device from now until ``close``; several at once are added up.

    Args:
        backend: the name of one of miniaudio's backends; whichever the machine has when None.

    Raises SpeechError where there is no miniaudio or no device.
    """

    def __init__(self, backend: str | None = None) -> None:
        self._lock = threading.Lock()
        self._playing: list[tuple[int, Samples]] = []
        self._place = 0
        self._device = _opened(backend)
        Sound(np.zeros(1, np.int16), 16_000).at_rate(
            _RATE_HZ
        )  # loads what it needs, so that the first sound is not late
        stream = self._stream()
        next(stream)
        try:
            with _quiet():
                self._device.start(stream)
        except Exception as error:  # miniaudio has errors of its own
            self.close()
            raise _no_device(error) from error

    def play(self, sound: Sound, in_s: float = 0.0) -> None:
        """Play ``sound`` in ``in_s`` seconds; below 0 for one that has begun so long ago."""
        samples = sound.at_rate(_RATE_HZ).samples
        delay = round(check_finite("in_s", in_s) * _RATE_HZ)
        with self._lock:
            self._playing.append((self._place + delay, samples))

    def hush(self) -> None:
        """End all that is played or waits, within ``FADE_S``."""
        with self._lock:
            now, playing = self._place, self._playing
            rests = [Sound(samples[now - start :], _RATE_HZ) for start, samples in playing if start <= now]
            self._playing = [(now, rest.until(min(FADE_S, rest.duration_s)).samples) for rest in rests]

    @property
    def busy(self) -> bool:
        """Whether something is played, or waits."""
        with self._lock:
            return bool(self._playing)

    def close(self) -> None:
        """Give the device back; may be called twice."""
        device, self._device = self._device, None
        if device is not None:
            device.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _stream(self) -> Generator[bytes, int, None]:
        count = yield b""
        while True:
            count = yield self._mixed(count).tobytes()

    def _mixed(self, count: int) -> Samples:
        """The next ``count`` samples."""
        mixed = np.zeros(count, np.int32)
        with self._lock:
            first, last = self._place, self._place + count
            for start, samples in self._playing:
                begin, end = max(start, first), min(start + len(samples), last)
                if begin < end:
                    mixed[begin - first : end - first] += samples[begin - start : end - start]
            self._playing = [(start, samples) for start, samples in self._playing if start + len(samples) > last]
            self._place = last
        return np.clip(mixed, -32768, 32767).astype(np.int16)


def _opened(backend: str | None) -> Any:
    try:
        import miniaudio
    except ImportError as error:
        raise SpeechError(_NO_MINIAUDIO) from error
    # the last one plays into the void
    wanted = [kind for kind in miniaudio.Backend if kind.name == (backend or kind.name)]
    wanted = [kind for kind in wanted if backend or kind.name not in ("NULL", "CUSTOM")]
    try:
        with _quiet():
            return miniaudio.PlaybackDevice(
                output_format=miniaudio.SampleFormat.SIGNED16,
                nchannels=1,
                sample_rate=_RATE_HZ,
                buffersize_msec=round(1000.0 * BUFFER_S),
                backends=wanted,
                app_name="agentface",
            )
    except Exception as error:  # miniaudio has errors of its own
        raise _no_device(error) from error


def _no_device(error: Exception) -> SpeechError:
    return SpeechError(_NO_DEVICE.format(reason=error.args[0] if error.args else type(error).__name__))


@contextmanager
def _quiet() -> Iterator[None]:
    """Without what ALSA's library writes past us to the standard error where it finds no device."""
    try:
        kept = os.dup(2)
    except OSError:
        yield
        return
    try:
        with suppress(OSError):
            nothing = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nothing, 2)
            os.close(nothing)
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)
