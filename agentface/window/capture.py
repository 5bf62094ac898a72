"""Pictures and films of what the window shows, as files with a time stamp in their names."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from datetime import datetime
from pathlib import Path

from agentface.conventions import Bytes
from agentface.errors import AgentFaceError
from agentface.live.films import FilmWriter

FILM_FPS = 30.0


class Capture:
    """Asked for at any time, done with the next frame.

    Args:
        write_picture: writes ``(H, W, 3)`` uint8 to a path.
        open_film: opens a film at a path, of a width and height, at so many frames a second; one that fails keeps what
            it has.
        say: tells where a file was written, or why it was not.
        folder: where the files go.
        now: the time that names a file.
    """

    def __init__(
        self,
        write_picture: Callable[[Path, Bytes], None],
        open_film: Callable[[Path, tuple[int, int], float], FilmWriter],
        say: Callable[[str], object] = print,
        folder: str | Path = Path(),
        now: Callable[[], datetime] = datetime.now,
    ) -> None:
        folder = Path(folder)
        self._write_picture, self._open_film, self._say = write_picture, open_film, say
        self._folder, self._now = folder, now
        self._film: FilmWriter | None = None
        self._path, self._size = Path(), (0, 0)
        self._start = self._last = 0.0
        self.message = ""
        """What was said last, the name of a file before its folder."""
        self.picture_wanted = False
        self.film_wanted = False

    @property
    def filmed_s(self) -> float | None:
        """The length of the film so far; None while there is none."""
        return None if self._film is None else self._last - self._start

    def frame(self, time_s: float, size: tuple[int, int], draw: Callable[[tuple[int, int]], Bytes]) -> None:
        """Take what is wanted of a frame; ``draw`` makes its picture in a size.

        A film keeps the size it began with. A file that cannot be written is told, and does not end the show.
        """
        try:
            self._take_picture(size, draw)
        except AgentFaceError as error:
            self._tell(str(error))
        self.picture_wanted = False
        try:
            self._take_film(time_s, size, draw)
        except AgentFaceError as error:
            self._tell(str(error))
            self.film_wanted = False
            film, self._film = self._film, None
            with suppress(AgentFaceError):  # told already
                if film is not None:
                    film.close()

    def close(self) -> None:
        """End the film; the file is valid."""
        self.film_wanted = False
        film, self._film = self._film, None
        if film is None:
            return
        try:
            film.close()
        except AgentFaceError as error:
            self._tell(str(error))
        else:
            self._tell(f"filmed {self._last - self._start:.1f} s:", self._path)

    def _take_picture(self, size: tuple[int, int], draw: Callable[[tuple[int, int]], Bytes]) -> None:
        if self.picture_wanted:
            path = self._fresh(".png")
            self._write_picture(path, draw(size))
            self._tell("wrote", path)

    def _take_film(self, time_s: float, size: tuple[int, int], draw: Callable[[tuple[int, int]], Bytes]) -> None:
        if self._film is not None and not self.film_wanted:
            self.close()
        if not self.film_wanted:
            return
        if self._film is None:
            # H.264 stores colour for two by two pixels
            self._size = (max(2, size[0] // 2 * 2), max(2, size[1] // 2 * 2))
            self._path = self._fresh(".mp4")
            self._film = self._open_film(self._path, self._size, FILM_FPS)
            self._start = self._last = time_s
            self._tell("filming to", self._path)
        elif int((time_s - self._start) * FILM_FPS) <= int((self._last - self._start) * FILM_FPS):
            return
        self._film.add(draw(self._size), time_s - self._start)
        self._last = time_s

    def _fresh(self, ending: str) -> Path:
        stem = f"agentface-{self._now():%Y%m%d-%H%M%S}"
        path, count = self._folder.absolute() / f"{stem}{ending}", 1
        while path.exists():
            count += 1
            path = path.with_name(f"{stem}-{count}{ending}")
        return path

    def _tell(self, message: str, path: Path | None = None) -> None:
        self.message = message if path is None else f"{message} {path.name} in {path.parent}"
        self._say(message if path is None else f"{message} {path}")
