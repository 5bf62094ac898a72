"""Pictures to a video file: H.264 in MP4, valid whenever the writing ends."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from fractions import Fraction
from os import SEEK_END
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, BinaryIO, Self

from agentface.conventions import Bytes, check_finite, check_rate
from agentface.errors import InvalidValueError, OutputError
from agentface.io.files import cannot_write, check_writable
from agentface.io.sound_track import Heard, SoundTrack, check_track

if TYPE_CHECKING:
    from av.container import OutputContainer
    from av.video.stream import VideoStream

SOUND_HZ = 48_000
"""Samples a second of a film's sound, unless its source has fewer."""
_TICKS = 90_000
_THREADS = 2  # a number of the machine's own would show in the file
_FRAGMENT_US = 250_000
_FORMATS = (".mp4", ".mov", ".m4v")


class VideoWriter:
    """Writes frames as they come, each shown from its own time on.

    The file is written in fragments of a quarter of a second: cut off at any moment, it plays up to there. An error in
    the ``with`` block, or a full disk, removes it; an interrupt (Ctrl-C) keeps it. The same frames at the same times
    give the same bytes, with the same versions of the libraries.

    Args:
        path: ends in .mp4, .mov or .m4v.
        size: width and height in pixels, both even: H.264 stores colour for two by two pixels.
        fps: the frame rate that is planned; the times given to ``add`` are what counts.
        keep: an error, or a full disk, too, leaves what is filmed until then: for what cannot be filmed again.
        sound: heard from the start of the film until its end, at the latest.

    Raises OutputError when the file cannot be written, InvalidValueError for a wrong size or rate.
    """

    def __init__(
        self,
        path: str | Path,
        size: tuple[int, int],
        fps: float = 30.0,
        *,
        keep: bool = False,
        sound: Heard | None = None,
    ) -> None:
        path = Path(path)
        check_video_name(path)
        check_writable(path)
        if sound is not None:
            check_track(sound)
        if any(side < 2 or side % 2 for side in size):
            raise InvalidValueError("video size", "an even width and height", size)
        self.path, self.size, self._keep = path, size, keep
        self._step = max(1, round(_TICKS / check_rate("fps", fps)))
        self._last = -1
        self._open = True
        self._file = _File(path)
        self._container, self._stream, self._track = _open(path, self._file, size, fps, sound)

    def add(self, image: Bytes, time_s: float) -> None:
        """Show ``image`` ``(H, W, 3)`` uint8 from ``time_s`` on, which is later than the time of the last frame.

        The first one is shown from 0 on: a file would begin with it, whatever its time, and the sound would be late.
        """
        from av.video.frame import VideoFrame

        if image.shape != (self.size[1], self.size[0], 3):
            raise InvalidValueError("video frame", f"the shape {(self.size[1], self.size[0], 3)}", image.shape)
        tick = round(check_finite("time_s", time_s) * _TICKS)
        if tick <= self._last:
            raise InvalidValueError("time_s", f"more than {self._last / _TICKS:g} s", time_s)
        for at in (0, tick) if self._last < 0 < tick else (tick,):
            frame = VideoFrame.from_ndarray(image, format="rgb24")
            frame.pts, frame.time_base = at, Fraction(1, _TICKS)
            self._mux(frame)
        self._last = tick
        if self._track is not None:
            self._mux_sound(
                self._track.until(self._last / _TICKS)
            )  # of one that grows, what comes later is not there yet

    def close(self) -> None:
        """Write what is left; may be called twice. Raises OutputError when that fails, and removes the file or not."""
        if not self._open:
            return
        try:
            self._mux(None)
            if self._track is not None:
                self._mux_sound(self._track.rest(self._end_s))
            with self._told():
                self._container.close()
            self._open = False
            self._file.close()
        finally:
            if self._open:
                self.discard()

    def discard(self) -> None:
        """Close and remove the file."""
        self._abandon()
        self.path.unlink(missing_ok=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._last < 0 or (isinstance(error, Exception) and not self._keep):
            self.discard()
        else:
            self.close()

    def _mux(self, frame: Any) -> None:
        with self._told():
            for packet in self._stream.encode(frame):
                packet.duration = packet.duration or self._step
                self._container.mux(packet)

    @property
    def _end_s(self) -> float:
        """When the last picture goes."""
        return (self._last + self._step) / _TICKS

    def _mux_sound(self, packets: Iterator[Any]) -> None:
        with self._told():
            for packet in packets:
                self._container.mux(packet)

    @contextmanager
    def _told(self) -> Iterator[None]:
        from av.error import FFmpegError

        try:
            yield
        except (FFmpegError, OSError) as error:
            raise self._failed(self._file.error or error) from error
        if self._file.error is not None:
            raise self._failed(self._file.error) from self._file.error

    def _failed(self, error: Exception) -> OutputError:
        message = cannot_write(self.path, error)
        if self._keep:
            self._abandon()
            until = keep_whole_fragments(self.path)
            message += f"; it is kept up to {until:.1f} s" if until else "; nothing of it could be kept"
        return OutputError(message)

    def _abandon(self) -> None:
        from av.error import FFmpegError

        if self._open:
            self._open = False
            with suppress(FFmpegError, OSError):  # a file that goes away need not be whole
                self._container.close()
            self._file.close()


class _File:
    """What FFmpeg writes to, unbuffered; keeps the first error, which FFmpeg forgets in the last fragment."""

    def __init__(self, path: Path) -> None:
        try:
            self._file = path.open("wb", buffering=0)
        except OSError as error:
            raise OutputError(cannot_write(path, error)) from error
        self.error: OSError | None = None
        self.close = self._file.close

    def write(self, content: bytes) -> int:
        rest = memoryview(content)
        if self.error is not None:  # what follows a gap is worth nothing
            raise self.error
        try:
            while rest:
                rest = rest[self._file.write(rest) :]
        except OSError as error:
            self.error = error
            raise
        return len(content)


def check_video_name(path: str | Path) -> None:
    """Raise OutputError for a name whose ending is no video format."""
    path = Path(path)
    if path.suffix.lower() not in _FORMATS:
        raise OutputError(
            f"{path}: expected a name that ends in {', '.join(_FORMATS)}, got {path.suffix or 'no ending'!r}"
        )


def keep_whole_fragments(path: str | Path) -> float:
    """Cut a film behind its last whole fragment; its length in seconds. Without any, the file is removed: 0."""
    import av

    path = Path(path)
    with path.open("r+b") as file:
        file.truncate(whole_fragments(file))
        empty = file.tell() == 0
    if empty:
        path.unlink()
        return 0.0
    with av.open(str(path)) as film:
        stream = film.streams.video[0]
        ends = [packet.pts + (packet.duration or 0) for packet in film.demux(stream) if packet.pts is not None]
        return float(max(ends) * (stream.time_base or 0))


def whole_fragments(file: BinaryIO) -> int:
    """How many of its bytes are whole fragments (ISO/IEC 14496-12, 8.8); ``file`` is left standing behind them."""
    size, place, whole = file.seek(0, SEEK_END), 0, 0
    while place + 8 <= size:
        file.seek(place)
        length, kind = struct.unpack(">I4s", file.read(8))
        if length < 8 or place + length > size:
            break
        place += length
        if kind == b"mdat":
            whole = place
    return file.seek(whole)


def _open(
    path: Path, file: _File, size: tuple[int, int], fps: float, sound: Heard | None
) -> tuple[OutputContainer, VideoStream, SoundTrack | None]:
    import av
    from av.error import FFmpegError
    from av.video.stream import VideoStream

    movie = {"movflags": "frag_keyframe+empty_moov+default_base_moof", "flush_packets": "1"}
    movie["frag_duration"] = str(_FRAGMENT_US)
    # Without frames that refer forward, the first one stands at 0 and none is lost when the writing is cut off.
    encoding = {"preset": "veryfast", "crf": "18", "bf": "0"}
    codec = "libx264" if "libx264" in av.codecs_available else "h264"
    if codec == "libx264":
        encoding["x264-params"] = "cpu-independent=1"
    try:
        container = av.open(file, "w", format="mp4", options=movie)
        stream = container.add_stream(codec, rate=Fraction(fps).limit_denominator(1001), options=encoding)
        if not isinstance(stream, VideoStream):
            raise ValueError(f"{codec} is no video codec")
        stream.width, stream.height = size
        stream.pix_fmt = "yuv420p"
        stream.codec_context.time_base = Fraction(1, _TICKS)
        stream.codec_context.gop_size = max(1, round(fps))
        stream.codec_context.thread_count = _THREADS
        track = None if sound is None else SoundTrack(container, sound)
        container.start_encoding()
    except (FFmpegError, OSError, ValueError) as error:
        file.close()
        path.unlink(missing_ok=True)
        if file.error is not None:
            raise OutputError(cannot_write(path, file.error)) from error
        raise OutputError(f"{path}: cannot be written as H.264: {error}") from error
    return container, stream, track
