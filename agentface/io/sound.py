"""Sound files: read from the usual formats, written as WAV."""

from __future__ import annotations

import io
import wave
from pathlib import Path
from typing import NoReturn

import numpy as np

from agentface.errors import DataError, Fault
from agentface.io.files import write_file
from agentface.speech.sound import Sound

HEARD_HZ = 16_000
"""What recognisers of speech hear."""
LONGEST_S = 600.0
"""No longer recording is read."""
_LARGEST_FILE = 1 << 30
# playlists, which lead to other files and addresses, are not among them
_FORMATS = "wav,w64,aiff,au,caf,flac,mp3,aac,ogg,matroska,webm,mov,mp4,m4a,3gp,avi,asf,mpegts,amr"


def read_sound(path: str | Path, rate_hz: int = HEARD_HZ) -> Sound:
    """The first sound track of a file, or of a film, as one channel of ``rate_hz`` samples a second.

    Its channels are mixed. Raises DataError for a file that is no sound, or longer than ``LONGEST_S`` seconds.
    """
    path = Path(path)
    if not path.is_file():
        _refuse(path, "a sound file", "something else" if path.exists() else "no file")
    if path.stat().st_size > _LARGEST_FILE:
        _refuse(path, f"a file of at most {_LARGEST_FILE} bytes", f"{path.stat().st_size} bytes")
    samples = np.frombuffer(_decoded(path, rate_hz), np.int16)
    if not len(samples):
        _refuse(path, "a file with sound", "an empty one")
    return Sound(samples, rate_hz)


def write_wav(path: str | Path, sound: Sound) -> None:
    """Write a sound as a WAV file of 16 bits; raises OutputError."""
    write_file(path, encode_wav(sound))


def encode_wav(sound: Sound) -> bytes:
    """A sound as a WAV file of 16 bits."""
    content = io.BytesIO()
    with wave.open(content, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(sound.rate_hz)
        file.writeframes(sound.samples.astype("<i2").tobytes())
    return content.getvalue()


def _decoded(path: Path, rate_hz: int) -> bytes:
    import av
    from av.audio.resampler import AudioResampler
    from av.error import FFmpegError

    most, found = 2 * round(LONGEST_S * rate_hz), bytearray()
    resampler = AudioResampler(format="s16", layout="mono", rate=rate_hz)
    options = {"format_whitelist": _FORMATS, "protocol_whitelist": "file"}
    try:
        with av.open(str(path), options=options) as file:
            if not file.streams.audio:
                _refuse(path, "a file with sound", "one without")
            for frame in file.decode(file.streams.audio[0]):
                frame.pts = None  # gaps are not filled, and a start that is not 0 is no silence
                for piece in resampler.resample(frame):
                    found += piece.to_ndarray().tobytes()
                if len(found) > most:
                    _refuse(path, f"at most {LONGEST_S:g} s of sound", "more")
            for piece in resampler.resample(None):
                found += piece.to_ndarray().tobytes()
    except (FFmpegError, OSError, ValueError) as error:
        _refuse(path, "a file with sound", getattr(error, "strerror", None) or str(error))
    return bytes(found[:most])


def _refuse(path: Path, expected: str, got: str) -> NoReturn:
    raise DataError([Fault(path, None, "", expected, got)])
