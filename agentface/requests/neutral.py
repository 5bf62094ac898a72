"""Ask a face to let go."""

from __future__ import annotations

from dataclasses import dataclass

from agentface.conventions import check_duration
from agentface.requests.request import FADE_S, Movable, Request


@dataclass(frozen=True, slots=True)
class Neutral(Request):
    """Let go of everything, within ``fade`` seconds: muscles, jaw, gaze, head, and whatever else moves it.

    The emotions go back to the mood.
    """

    fade: float = FADE_S

    def __post_init__(self) -> None:
        self._keep(fade=check_duration("fade", self.fade))

    def apply(self, face: Movable) -> None:
        """Tell every channel."""
        face.channels.release(self.fade)
