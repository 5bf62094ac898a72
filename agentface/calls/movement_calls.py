""":class:`MovementCalls`: where a face looks, what it does and how it lives."""

from __future__ import annotations

from collections.abc import Sequence

from agentface.bml.block import Block
from agentface.calls.calls import Calls
from agentface.motion.performance import Performance
from agentface.requests import (
    GAZE_FADE_S,
    HEAD_FADE_S,
    Blink,
    Gesture,
    LookAt,
    Play,
    PlayBlock,
    SetGaze,
    SetHead,
    SetLiveliness,
    SetState,
)


class MovementCalls(Calls):
    """A face's eyes and head, its gestures, and whole performances."""

    def set_gaze(self, yaw_deg: float, pitch_deg: float, *, fade: float = GAZE_FADE_S) -> None:
        """Look ``yaw_deg`` to the person's left (-50..50) and ``pitch_deg`` up (-40..40); a saccade by default."""
        self.apply(SetGaze(yaw_deg, pitch_deg, fade))

    def look_at(self, point: Sequence[float], *, fade: float | None = None) -> None:
        """Look at a point, each eye exactly: x, y, z in metres in the model's axes, where the head is not turned.

        It is looked at until the gaze is told otherwise, whatever turns the head; the head joins the eyes for what is
        far aside. The eyes take ``fade`` seconds, those of a leap so far when None. Raises InvalidValueError for a
        point that is not in front of the eyes.
        """
        self.apply(LookAt.of(point, fade))

    def set_head(self, yaw_deg: float, pitch_deg: float, roll_deg: float = 0.0, *, fade: float = HEAD_FADE_S) -> None:
        """Turn the head to its left (-80..80), up (-60..60), and tilt it to its left (-50..50)."""
        self.apply(SetHead(yaw_deg, pitch_deg, roll_deg, fade))

    def blink(self) -> None:
        """Blink once."""
        self.apply(Blink())

    def gesture(self, name: str, strength: float = 1.0) -> None:
        """Nod, shake, tilt, ...: a gesture of ``rules/gestures.yaml``, at ``strength`` 0..1."""
        self.apply(Gesture(name, strength))

    def set_liveliness(self, liveliness: float, *, fade: float | None = None) -> None:
        """Blink, look about, sway and breathe between messages: 0, perfectly still, .. 1; 0.6 is natural.

        In ``fade`` seconds, those of ``rules/life.yaml`` when None.
        """
        self.apply(SetLiveliness(liveliness, fade))

    def set_state(self, state: str | None) -> None:
        """What it lives for: ``idle``, ``listening``, ``thinking`` or ``speaking``.

        None, as at first: ``speaking`` while the face speaks, and ``idle`` otherwise.
        """
        self.apply(SetState(state))

    def play(self, performance: Performance | None, *, fade: float = 0.0) -> None:
        """Play poses over time from now on, and let go when they end; None ends the one that is played.

        With a fade of 0 every frame is hit exactly; else the face comes to it from what it shows in ``fade`` seconds.
        """
        self.apply(Play(performance, fade))

    def play_block(self, block: Block) -> None:
        """Play a BML block, as :func:`agentface.io.bml.reader.read_bml` reads it; what it says, once it is spoken.

        Raises InvalidValueError for one whose id plays or waits already, and when too many wait.
        """
        self.apply(PlayBlock(block))
