"""What is heard, as pieces that travel beside the frames."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from agentface.errors import InvalidValueError
from agentface.speech.sound import SLOWEST_RATE_HZ, Samples, Sound

AUDIO = 2
"""The first byte of a message that is a piece of sound."""
PIECE_S = 0.25
_HEADER = struct.Struct("<BBHId")


@dataclass(frozen=True, eq=False, slots=True)
class Piece:
    """One channel of sound from ``start_s`` of the frames' time on; without samples: what was sent is not heard on.

    Attributes:
        start_s: when its first sample is heard.
        rate_hz: samples a second.
        samples: ``(N,)`` int16.
    """

    start_s: float
    rate_hz: int
    samples: Samples

    def encode(self) -> bytes:
        """Byte 2, the number of channels, 16 bits of 0, the rate in 32 bits, the start in a double, the samples."""
        return _HEADER.pack(AUDIO, 1, 0, self.rate_hz, self.start_s) + self.samples.astype("<i2").tobytes()

    @classmethod
    def decode(cls, message: bytes) -> Piece:
        """What a message holds; raises InvalidValueError for one that is no piece of sound."""
        if len(message) < _HEADER.size or message[0] != AUDIO or (len(message) - _HEADER.size) % 2:
            raise InvalidValueError("sound", f"a message that begins with {AUDIO}, 16 bytes and samples", message[:16])
        _, channels, _, rate, start = _HEADER.unpack_from(message)
        if channels != 1:
            raise InvalidValueError("sound", "one channel", channels)
        return cls(start, rate, np.frombuffer(message, "<i2", offset=_HEADER.size).astype(np.int16))


def pieces(sound: Sound, start_s: float, from_s: float = -np.inf) -> Iterator[Piece]:
    """A sound that begins at ``start_s``, in pieces, as far as it is heard after ``from_s``."""
    size = max(1, round(PIECE_S * sound.rate_hz))
    for first in range(0, len(sound.samples), size):
        part = sound.samples[first : first + size]
        begins = start_s + first / sound.rate_hz
        if begins + len(part) / sound.rate_hz > from_s:
            yield Piece(begins, sound.rate_hz, part)


def silence(at_s: float) -> Piece:
    """What ends all that was sent, at ``at_s``."""
    return Piece(at_s, SLOWEST_RATE_HZ, np.zeros(0, np.int16))
