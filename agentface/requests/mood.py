"""Ask for a mood."""

from __future__ import annotations

from dataclasses import dataclass

from agentface.emotion.state import EmotionState
from agentface.requests.emotion import check_fade
from agentface.requests.request import Movable, Request


@dataclass(frozen=True, slots=True)
class SetMood(Request):
    """What the face goes back to after expressions, and shows where it is shown nothing else.

    Attributes:
        state: all six intensities; also a mapping from names, of which those that are missing are 0.
        fade: seconds until it is reached; None for a mood's own pace.
    """

    state: EmotionState
    fade: float | None = None

    def __post_init__(self) -> None:
        self._keep(state=EmotionState.of(self.state), fade=check_fade(self.fade))

    def apply(self, face: Movable) -> None:
        """Tell the emotion channel."""
        face.channels.emotion.change_mood(self.state, self.fade)
