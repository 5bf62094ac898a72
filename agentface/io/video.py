"""Pictures to a video file: H.264 in MP4, valid whenever the writing ends."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

from agentface.conventions import Bytes, check_finite
from agentface.errors import InvalidValueError, OutputError
from agentface.io.files import check_writable

if TYPE_CHECKING:
    from av.container import OutputContainer
    from av.video.stream import VideoStream

_TICKS = 90_000
_FORMATS = (".mp4", ".mov", ".m4v")


class VideoWriter:
    """Writes frames as they come, each shown from its own time on.

    The file is written in fragments of a second: cut off at any moment, it plays up to there. An error in the
    ``with`` block removes it; an interrupt (Ctrl-C) keeps it.

    Args:
        path: ends in .mp4, .mov or .m4v.
        size: width and height in pixels, both even: H.264 stores colour for two by two pixels.
        fps: the frame rate that is planned; the times given to ``add`` are what counts.

    Raises OutputError when the file cannot be written, InvalidValueError for a wrong size.
    """

    def __init__(self, path: Path, size: tuple[int, int], fps: float = 30.0) -> None:
        check_video_name(path)
        check_writable(path)
        if any(side < 2 or side % 2 for side in size):
            raise InvalidValueError("video size", "an even width and height", size)
        self.path, self.size = path, size
        self._step = max(1, round(_TICKS / fps))
        self._last = -1
        self._open = True
        self._container, self._stream = _open(path, size, fps)

    def add(self, image: Bytes, time_s: float) -> None:
        """Show ``image`` ``(H, W, 3)`` uint8 from ``time_s`` on, which is later than the time of the last frame."""
        from av.video.frame import VideoFrame

        if image.shape != (self.size[1], self.size[0], 3):
            raise InvalidValueError("video frame", f"the shape {(self.size[1], self.size[0], 3)}", image.shape)
        tick = round(check_finite("time_s", time_s) * _TICKS)
        if tick <= self._last:
            raise InvalidValueError("time_s", f"more than {self._last / _TICKS:g} s", time_s)
        frame = VideoFrame.from_ndarray(image, format="rgb24")
        frame.pts, frame.time_base = tick, Fraction(1, _TICKS)
        self._last = tick
        self._mux(frame)

    def close(self) -> None:
        """Write what is left; may be called twice."""
        if not self._open:
            return
        self._open = False
        try:
            self._mux(None)
        finally:
            self._container.close()

    def discard(self) -> None:
        """Close and remove the file."""
        if self._open:
            self._open = False
            self._container.close()
        self.path.unlink(missing_ok=True)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if isinstance(error, Exception) or self._last < 0:
            self.discard()
        else:
            self.close()

    def _mux(self, frame: Any) -> None:
        from av.error import FFmpegError

        try:
            for packet in self._stream.encode(frame):
                packet.duration = packet.duration or self._step
                self._container.mux(packet)
        except (FFmpegError, OSError) as error:
            raise OutputError(f"{self.path}: cannot be written: {error.strerror or error}") from error


def check_video_name(path: Path) -> None:
    """Raise OutputError for a name whose ending is no video format."""
    if path.suffix.lower() not in _FORMATS:
        raise OutputError(
            f"{path}: expected a name that ends in {', '.join(_FORMATS)}, got {path.suffix or 'no ending'!r}"
        )


def _open(path: Path, size: tuple[int, int], fps: float) -> tuple[OutputContainer, VideoStream]:
    import av
    from av.error import FFmpegError
    from av.video.stream import VideoStream

    movie = {"movflags": "frag_keyframe+empty_moov+default_base_moof", "flush_packets": "1"}
    # Without frames that refer forward, the first one stands at 0 and none is lost when the writing is cut off.
    encoding = {"preset": "veryfast", "crf": "18", "bf": "0"}
    codec = "libx264" if "libx264" in av.codecs_available else "h264"
    try:
        container = av.open(str(path), "w", format="mp4", options=movie)
        stream = container.add_stream(codec, rate=Fraction(fps).limit_denominator(1001), options=encoding)
    except (FFmpegError, OSError, ValueError) as error:
        raise OutputError(f"{path}: cannot be written as H.264: {error}") from error
    if not isinstance(stream, VideoStream):
        raise OutputError(f"{path}: cannot be written as H.264: {codec} is no video codec")
    stream.width, stream.height = size
    stream.pix_fmt = "yuv420p"
    stream.codec_context.time_base = Fraction(1, _TICKS)
    stream.codec_context.gop_size = max(1, round(fps))
    return container, stream
