"""Pictures to numbered PNG files, for editing programs: one a frame, with their transparency."""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path
from types import TracebackType
from typing import Self

from agentface.conventions import Bytes, check_finite, check_rate
from agentface.errors import InvalidValueError, OutputError
from agentface.io.files import check_writable, write_file
from agentface.io.picture import encode

_NUMBER = re.compile(r"%0([1-9])d")


class SequenceWriter:
    """Writes file number ``n`` with what is shown at ``n / fps`` seconds, whatever the times of the frames.

    A frame that comes late is filled in with the one before; of two within one step, the later stands. Every file is
    written as a whole. An error in the ``with`` block removes those that were written; an interrupt (Ctrl-C) keeps
    them. The same frames at the same times give the same files.

    Args:
        path: ends in .png, with the place of the number as in ``frames/face-%05d.png``.
        size: width and height in pixels.
        fps: files a second.
        keep: an error, too, leaves what is written until then: for what cannot be filmed again.

    Raises OutputError for another name, for a folder that cannot be written, and when it has such files already: what
    is left of a longer sequence would follow this one.
    """

    def __init__(self, path: str | Path, size: tuple[int, int], fps: float = 30.0, *, keep: bool = False) -> None:
        path = Path(path)
        self._digits = check_sequence_name(path)
        check_writable(path)
        self.path, self.size, self._fps, self._keep = path, size, check_rate("fps", fps), keep
        _check_none_there(path)
        self._last = -1.0
        self._next = 0
        self._held: tuple[int, bytes] | None = None
        self._written: list[Path] = []

    def add(self, image: Bytes, time_s: float) -> None:
        """Show ``image`` ``(H, W, 4)`` or ``(H, W, 3)`` uint8 from ``time_s`` on, later than the last frame's time."""
        if image.shape not in ((self.size[1], self.size[0], 3), (self.size[1], self.size[0], 4)):
            raise InvalidValueError("frame", f"the shape {(self.size[1], self.size[0])} and 3 or 4", image.shape)
        if not check_finite("time_s", time_s) >= 0.0 or time_s <= self._last:
            raise InvalidValueError("time_s", f"more than {max(self._last, 0.0):g} s", time_s)
        number = int(time_s * self._fps + 0.5)
        self._write_until(number)
        self._held = number, encode(image, self.path)
        self._last = time_s

    def close(self) -> None:
        """Write what is left; may be called twice."""
        if self._held is not None:
            self._write_until(self._held[0] + 1)
            self._held = None

    def discard(self) -> None:
        """Remove the files that were written."""
        self._held = None
        for path in self._written:
            with suppress(OSError):
                path.unlink(missing_ok=True)
        self._written.clear()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if isinstance(error, Exception) and not self._keep:
            self.discard()
            return
        try:
            self.close()
        except OutputError:
            if not self._keep:
                self.discard()
            raise

    def _write_until(self, number: int) -> None:
        while self._held is not None and self._next < number:
            path = self.path.with_name(_NUMBER.sub(f"{self._next:0{self._digits}d}", self.path.name))
            try:
                write_file(path, self._held[1])
            except OutputError as error:
                self._held = None
                kept = f"; the {self._next} files before it are kept" if self._keep else ""
                raise OutputError(f"{error}{kept}") from error
            self._written.append(path)
            self._next += 1


def check_sequence_name(path: str | Path) -> int:
    """The number of digits that the name asks for; raises OutputError for one without a place for the number."""
    path = Path(path)
    places = _NUMBER.findall(path.name)
    if path.suffix.lower() != ".png" or len(places) != 1 or path.name.count("%") != 1:
        example = path.with_name(f"{path.stem.partition('%')[0].rstrip('-_') or 'face'}-%05d.png")
        raise OutputError(f"{path}: expected a name with one place for the number, such as {example}")
    return int(places[0])


def _check_none_there(path: Path) -> None:
    before, after = (re.escape(part) for part in _NUMBER.split(path.name)[::2])
    likewise = re.compile(f"{before}[0-9]+{after}")
    there = sorted(each.name for each in path.parent.iterdir() if likewise.fullmatch(each.name))
    if there:
        raise OutputError(
            f"{path}: expected no such files yet, got {len(there)} ({there[0]} is one);"
            " remove them, or choose another name"
        )
