"""The sound of a film: AAC beside the pictures, in time to the sample."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from typing import TYPE_CHECKING, Any, Protocol

from agentface.errors import InvalidValueError
from agentface.speech.sound import Samples

if TYPE_CHECKING:
    from av.container import OutputContainer

_RATES_HZ = (96000, 88200, 64000, 48000, 44100, 32000, 24000, 22050, 16000, 12000, 11025, 8000)
_BITS_A_SECOND = 96_000
_BLOCK = 1024
"""The samples of a packet of AAC."""


class Heard(Protocol):
    """What a film takes its sound of: a ``Sound``, or one that grows while it is filmed."""

    @property
    def rate_hz(self) -> int:
        """Samples a second."""

    def part(self, first: int, count: int) -> Samples:
        """``count`` samples from that at ``first`` on, each asked for once and in its time."""


def check_track(sound: Heard) -> None:
    """Raise InvalidValueError for a sound whose rate AAC does not have."""
    if sound.rate_hz not in _RATES_HZ:
        raise InvalidValueError("rate of a film's sound", f"one of {', '.join(map(str, _RATES_HZ))}", sound.rate_hz)


class SoundTrack:
    """Packets of a sound, for a container whose encoding has not begun; it starts with the film.

    After its end it is silent: a muxer holds pictures back while it waits for the sound beside them.
    """

    def __init__(self, container: OutputContainer, sound: Heard) -> None:
        from av.audio.stream import AudioStream

        stream = container.add_stream("aac", rate=sound.rate_hz)
        assert isinstance(stream, AudioStream)  # noqa: S101 - for the type checker
        stream.layout = "mono"
        stream.bit_rate = _BITS_A_SECOND
        stream.codec_context.time_base = Fraction(1, sound.rate_hz)
        self._stream, self._sound, self._place = stream, sound, 0

    def until(self, time_s: float) -> Iterator[Any]:
        """The whole packets that are still to be written up to a time, in seconds of the film."""
        end = round(time_s * self._sound.rate_hz)
        while self._place + _BLOCK <= end:
            yield from self._encoded(_BLOCK)

    def rest(self, time_s: float) -> Iterator[Any]:
        """The last packets; what is later than ``time_s`` is not heard."""
        yield from self.until(time_s)
        left = round(time_s * self._sound.rate_hz) - self._place
        if left > 0:
            yield from self._encoded(left)
        yield from self._timely(self._stream.encode(None))

    def _encoded(self, count: int) -> Iterator[Any]:
        from av.audio.frame import AudioFrame

        samples = self._sound.part(self._place, count)
        frame = AudioFrame.from_ndarray(samples[None], format="s16", layout="mono")
        frame.sample_rate = self._sound.rate_hz
        frame.pts, frame.time_base = self._place, Fraction(1, self._sound.rate_hz)
        self._place += count
        yield from self._timely(self._stream.encode(frame))

    def _timely(self, packets: list[Any]) -> Iterator[Any]:
        # The encoder puts a packet of silence before the start, by whose length a film in fragments would be late.
        return (packet for packet in packets if packet.pts is None or packet.pts >= 0)
