"""Six intensities in time, and the contractions that the rules make of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Protocol

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.motion.envelope import Envelope
from agentface.parameters import MUSCLES, NAMES, indices_of


class EmotionRules(Protocol):
    """What turns emotions into contractions: ``agentface.emotion.inference.Inference``."""

    def contractions(self, state: EmotionState) -> Doubles:
        """``(len(MUSCLES),)`` in 0..1."""


class EmotionChannel:
    """Six target intensities, each with its own end, and the contractions that the rules make of them.

    The change goes muscle by muscle from the contractions shown now to those of the new state; of these each side of
    the face makes its ``gains (COUNT,)``.
    """

    def __init__(self, rules: EmotionRules, gains: Floats | None = None) -> None:
        self._rules = rules
        self.target = EmotionState()
        self.intensities = Envelope(len(EMOTIONS))
        self._muscles = Envelope(len(MUSCLES))
        self._left = np.full(len(EMOTIONS), math.inf)
        self._fades = np.zeros(len(EMOTIONS))
        places = [(index, row) for row, muscle in enumerate(MUSCLES) for index in indices_of(muscle)]
        self.names = tuple(NAMES[index] for index, _ in places)
        self._rows = np.array([row for _, row in places])
        self._gains = (
            np.ones(len(places)) if gains is None else gains[[index for index, _ in places]].astype(np.float64)
        )

    def change(self, intensities: Mapping[str, float], fade: float, hold: float | None) -> None:
        """Set some emotions, leave the others; with ``hold`` these return to 0 that many seconds after the fade.

        ``intensities`` maps names of ``EMOTIONS`` to 0..1.
        """
        places = [EMOTIONS.index(emotion) for emotion in intensities]
        self._left[places] = math.inf if hold is None else fade + hold
        self._fades[places] = fade
        self._aim(self.target.as_dict() | dict(intensities), fade)

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        while self._left.min() < dt:
            part = float(max(self._left.min(), 0.0))
            self._advance(part)
            dt -= part
            ended = self._left <= 0.0
            fade = float(self._fades[ended].max())
            self._left[ended] = math.inf
            self._aim(dict(zip(EMOTIONS, np.where(ended, 0.0, self.target.array).tolist(), strict=True)), fade)
        self._advance(dt)

    def release(self, fade: float) -> None:
        """Let go of all six."""
        self.change(EmotionState(), fade, None)

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """The contractions now."""
        if self._muscles.resting:
            return False
        np.take(self._muscles.value, self._rows, out=values)
        values *= self._gains
        return True

    def _advance(self, dt: float) -> None:
        self._left -= dt
        self.intensities.advance(dt)
        self._muscles.advance(dt)

    def _aim(self, intensities: Mapping[str, float], fade: float) -> None:
        self.target = EmotionState.of(intensities)
        self.intensities.move(self.target.array, fade)
        self._muscles.move(self._rules.contractions(self.target), fade)
