""":class:`StreamChannel`: frames in the terms of a standard that arrive one by one, and the poses that show them."""

from __future__ import annotations

from abc import abstractmethod

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel
from agentface.motion.playing import PerformanceChannel

STREAM_FADE_S = 0.04
"""Over so long one frame of a stream goes over into the next: as long as frames of 25 a second are apart."""


class StreamChannel(PerformanceChannel):
    """The newest frame, held for ``HOLD_S`` and then let go of within ``LET_GO_S``.

    It moves what the frame determines and leaves the rest to others. A frame is solved when the face is next asked for
    its pose: of several that arrive before, only what they make together.
    """

    def __init__(self) -> None:
        super().__init__()
        self._new_for: HeadModel | None = None
        self._fade = STREAM_FADE_S

    @property
    def fresh(self) -> bool:
        """Whether nothing of an earlier frame is shown or waits."""
        return not self.playing and self._new_for is None

    @abstractmethod
    def solved(self, model: HeadModel) -> tuple[Floats, Floats]:
        """The frame that waits, as values and weights ``(COUNT,)``, on a face."""

    def release(self, fade: float) -> None:
        """Let go within ``fade`` seconds."""
        self._new_for = None
        super().release(fade)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        self._show_new()
        super().advance(dt)

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """What is shown now, and how much of each parameter it moves."""
        self._show_new()
        return super().write(values, weights)

    def arrived(self, model: HeadModel, fade: float) -> None:
        """A frame waits to be shown, within ``fade`` seconds."""
        self._new_for, self._fade = model, fade

    def _show_new(self) -> None:
        model, self._new_for = self._new_for, None
        if model is not None:
            self.show(*self.solved(model), self._fade)
