""":class:`Pace`: when the next frame is due."""

from __future__ import annotations

from agentface.clock import Clock

LONGEST_PAUSE_S = 0.5
"""Who asks for a frame later than that has missed none: the time of the frames has stood still."""
_ROUNDING = 1e-6


class Pace:
    """Frames on a grid of ``1 / fps`` s, which begins with the first :meth:`wait`."""

    def __init__(self, clock: Clock, fps: float) -> None:
        self._clock, self._fps = clock, fps
        self._start: float | None = None
        self._frame = -1

    def wait(self, ahead_s: float) -> int:
        """Wait until ``ahead_s`` before the next frame's time; how many frames further the one is that is now due.

        More than 1 where the time of the next one is over.
        """
        if self._start is None:
            self._start = self._clock.now()
        time = self._start + (self._frame + 1) / self._fps
        if time - ahead_s > self._clock.now():
            self._clock.sleep(time - ahead_s - self._clock.now())
        late_s = max(0.0, self._clock.now() - time)
        if late_s > LONGEST_PAUSE_S:
            self._start += late_s
            late_s = 0.0
        frames = 1 + int(late_s * self._fps + _ROUNDING)
        self._frame += frames
        return frames
