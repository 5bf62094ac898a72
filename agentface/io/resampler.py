""":class:`Resampler`: sound in pieces, of any rate and number of channels, as one channel of another rate."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.errors import InvalidValueError
from agentface.speech.sound import FASTEST_RATE_HZ, SLOWEST_RATE_HZ, Samples

MOST_CHANNELS = 8


class Resampler:
    """One sound, piece by piece; sound of the rate and channels that are wanted passes through sample for sample.

    Args:
        rate_hz: samples a second of what comes, a whole number in 4000..192000.
        channels: 1..8; they are mixed.
        to_hz: samples a second of what goes.

    Raises InvalidValueError.
    """

    def __init__(self, rate_hz: int, channels: int, to_hz: int) -> None:
        for name, value, least, most in (
            ("sound rate", rate_hz, SLOWEST_RATE_HZ, FASTEST_RATE_HZ),
            ("sound rate out", to_hz, SLOWEST_RATE_HZ, FASTEST_RATE_HZ),
            ("channels", channels, 1, MOST_CHANNELS),
        ):
            if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
                raise InvalidValueError(name, f"a whole number in {least}..{most}", value)
        self._rate_hz, self._channels, self._to_hz = rate_hz, channels, to_hz
        self._frames = _frames(to_hz) if rate_hz != to_hz else None

    def feed(self, samples: Samples) -> Samples:
        """What comes of the next piece, ``(N,)`` int16, its channels sample by sample; a little comes later.

        Raises InvalidValueError for another type, or for one that ends within a sample of all channels.
        """
        if samples.dtype != np.int16 or samples.ndim != 1 or len(samples) % self._channels:
            got = f"{samples.dtype} of shape {samples.shape}"
            raise InvalidValueError("samples", f"int16 of shape (N,), {self._channels} channels in turn", got)
        mono = samples
        if self._channels > 1:
            mono = np.round(samples.reshape(-1, self._channels).mean(axis=1)).astype(np.int16)
        if self._frames is None or not len(mono):
            return mono
        from av.audio.frame import AudioFrame

        frame = AudioFrame.from_ndarray(mono[None], format="s16", layout="mono")
        frame.sample_rate = self._rate_hz
        return _joined(self._frames.resample(frame))

    def end(self) -> Samples:
        """The rest; what is fed next begins another sound."""
        if self._frames is None:
            return np.zeros(0, np.int16)
        rest = _joined(self._frames.resample(None))
        self._frames = _frames(self._to_hz)
        return rest


def _frames(to_hz: int) -> Any:
    from av.audio.resampler import AudioResampler

    return AudioResampler(format="s16", layout="mono", rate=to_hz)


def _joined(frames: list[Any]) -> Samples:
    return np.concatenate([np.zeros(0, np.int16), *(frame.to_ndarray()[0] for frame in frames)])
