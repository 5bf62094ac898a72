"""A performance that is played: the source of what a file of poses, FAPs or action units tells a face."""

from __future__ import annotations

from agentface.face import Face
from agentface.motion.performance import LET_GO_S, Performance
from agentface.requests import Play


class PerformancePlayer:
    """Plays ``performance`` to ``face`` from the start of the loop; with ``again``, anew whenever it ends.

    It begins on its first frame exactly; anew, it comes to it from the last one within ``LET_GO_S``.
    """

    def __init__(self, face: Face, performance: Performance, *, again: bool = False) -> None:
        self._face, self._performance, self._again = face, performance, again
        self._rounds = 0

    def take_in(self, time_s: float) -> None:
        """Ask for the performance when it has come due."""
        due = self._rounds == 0 or (self._again and time_s >= self._rounds * self._round_s)
        if due:
            self._face.apply(Play(self._performance, LET_GO_S if self._rounds else 0.0))
            self._rounds += 1

    @property
    def _round_s(self) -> float:
        return max(self._performance.duration_s, LET_GO_S)
