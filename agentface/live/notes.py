"""What a face was asked, written down while it runs, and asked of another face later."""

from __future__ import annotations

from types import TracebackType
from typing import Self

from agentface.conventions import check_rate
from agentface.face import Face
from agentface.live.loop import Frame
from agentface.requests import PlayBlock, Request, Say

Note = tuple[float, Request]
"""When the step began before which something was asked, in seconds since the loop did; and what."""


class Recorder:
    """Writes down what a face is asked, by whomever, in a ``with`` block; a sink of the loop in which it is stepped.

    Attributes:
        notes: in the order in which they were asked.
        last_s: the time of the last frame; None before the first.
    """

    def __init__(self, face: Face) -> None:
        self._face = face
        self.notes: list[Note] = []
        self.last_s: float | None = None

    def show(self, frame: Frame) -> None:
        """Note the time: what is asked now belongs to the step that begins here."""
        self.last_s = frame.time_s

    def __enter__(self) -> Self:
        self._face.noted.append(self._note)
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._face.noted.remove(self._note)

    def _note(self, request: Request) -> None:
        self.notes.append((self.last_s or 0.0, request))


class Replay:
    """The source that asks ``face`` what was noted before: one that began in the same way does the same again.

    What was asked between two frames of ``fps`` a second is asked at the nearer one: in real time a frame is never
    exactly at its time.
    """

    def __init__(self, face: Face, notes: list[Note], fps: float) -> None:
        self._face, self._notes = face, notes
        self._fps = check_rate("fps", fps)
        self._next = 0

    def take_in(self, time_s: float) -> None:
        """Ask what has come due."""
        frame = round(time_s * self._fps)
        while self._next < len(self._notes) and round(self._notes[self._next][0] * self._fps) <= frame:
            request = self._notes[self._next][1]
            if not isinstance(request, Say | PlayBlock):  # what came of it is noted, too
                self._face.apply(request)
            self._next += 1
