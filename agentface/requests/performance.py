"""Ask for a performance."""

from __future__ import annotations

from dataclasses import dataclass

from agentface.conventions import check_duration
from agentface.errors import InvalidValueError
from agentface.motion.doing import Doing
from agentface.motion.performance import Performance
from agentface.requests.request import Movable, Request


@dataclass(frozen=True, slots=True)
class Play(Request):
    """A performance from its beginning, in place of the one that is played.

    Attributes:
        performance: poses over time; None ends the one that is played.
        fade: seconds until the face has come to it from what it shows; with 0 every frame is hit exactly.
    """

    performance: Performance | None
    fade: float = 0.0

    def __post_init__(self) -> None:
        if not isinstance(self.performance, Performance | None):
            raise InvalidValueError("performance", "a Performance or None", self.performance)
        self._keep(fade=check_duration("fade", self.fade))

    def apply(self, face: Movable) -> Doing | None:
        """Tell the performances' channel."""
        if self.performance is None:
            face.channels.performance.release(self.fade)
            return None
        return face.channels.performance.play(self.performance, self.fade)
