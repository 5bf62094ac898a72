"""The channels together: one pose of what all of them ask for."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.emotion.state import EmotionState
from agentface.motion.blink import BlinkChannel
from agentface.motion.channels import Contractor, EmotionChannel, MuscleChannel, TurnChannel
from agentface.parameters import COUNT, FacePose


class Mixer:
    """Channels in the order in which they are written.

    Contractions of different channels merge by their maximum: two causes do not contract a muscle twice. A
    muscle that is set by name comes last and wins over all of them. Gaze and head have parameters of their own.
    ``gains (COUNT,)`` is what the sides of the face make of what an emotion asks of both.
    """

    def __init__(self, inference: Contractor, gains: Floats | None = None) -> None:
        self.emotion = EmotionChannel(inference, gains)
        self.blink = BlinkChannel()
        self.muscles = MuscleChannel()
        self.gaze = TurnChannel("gaze")
        self.head = TurnChannel("head")
        self._channels = (self.emotion, self.blink, self.muscles, self.gaze, self.head)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass in every channel."""
        for channel in self._channels:
            channel.advance(dt)

    def release(self, fade: float) -> None:
        """Let go of everything within ``fade`` seconds; a blink runs to its end."""
        self.emotion.change(EmotionState(), fade, None)
        self.muscles.release(fade)
        self.gaze.turn((0.0, 0.0, 0.0), fade)
        self.head.turn((0.0, 0.0, 0.0), fade)

    def pose(self) -> FacePose:
        """The parameters shown now."""
        values = np.zeros(COUNT)
        for channel in self._channels:
            channel.write(values)
        return FacePose(values.astype(np.float32))
