"""What is said, on the machine's sound device."""

from __future__ import annotations

import os
import threading
from collections.abc import Generator, Iterator
from contextlib import contextmanager, suppress
from types import TracebackType
from typing import Any, Self

import numpy as np

from agentface.conventions import check_duration
from agentface.errors import SpeechError
from agentface.speech.sound import Samples, Sound

_RATE_HZ = 48_000
_BUFFER_MS = 60
_FADE_S = 0.02
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
        _resampled(Sound(np.zeros(1, np.int16), 16_000))  # loads what it needs, so that the first sound is not late
        stream = self._stream()
        next(stream)
        try:
            with _quiet():
                self._device.start(stream)
        except Exception as error:  # miniaudio has errors of its own
            self.close()
            raise _no_device(error) from error

    @property
    def latency_s(self) -> float:
        """How much later than it is played a sound is heard, about."""
        return _BUFFER_MS / 1000.0

    def play(self, sound: Sound, in_s: float = 0.0) -> None:
        """Play ``sound`` in ``in_s`` seconds."""
        samples = _resampled(sound)
        delay = round(check_duration("in_s", in_s) * _RATE_HZ)
        with self._lock:
            self._playing.append((self._place + delay, samples))

    def hush(self) -> None:
        """End all that is played or waits, within a fiftieth of a second."""
        count = round(_FADE_S * _RATE_HZ)
        fade = np.linspace(1.0, 0.0, count)
        with self._lock:
            now = self._place
            playing, self._playing = self._playing, []
            for start, samples in playing:
                rest = samples[max(now - start, 0) :][:count] if start <= now else samples[:0]
                if len(rest):
                    self._playing.append((now, (rest * fade[: len(rest)]).astype(np.int16)))

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


def _resampled(sound: Sound) -> Samples:
    if sound.rate_hz == _RATE_HZ or not len(sound.samples):
        return sound.samples
    from scipy.signal import resample_poly

    up = np.gcd(_RATE_HZ, sound.rate_hz)
    samples = resample_poly(sound.samples.astype(np.float64), _RATE_HZ // up, sound.rate_hz // up)
    return np.clip(np.round(samples), -32768, 32767).astype(np.int16)


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
                buffersize_msec=_BUFFER_MS,
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
