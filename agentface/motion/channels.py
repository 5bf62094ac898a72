"""What moves the face: each channel is one source of parameter values, moved on by ``advance``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Protocol

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.motion.envelope import Envelope
from agentface.parameters import COUNT, MUSCLES, NAMES, PARAMETERS, indices_of


class Contractor(Protocol):
    """What turns emotions into contractions: ``agentface.emotion.inference.Inference``."""

    def contractions(self, state: EmotionState) -> Doubles:
        """``(len(MUSCLES),)`` in 0..1."""


class EmotionChannel:
    """Six target intensities, each with its own end, and the contractions that the rules make of them.

    The change goes muscle by muscle from the contractions shown now to those of the new state; of these each side of
    the face makes its ``gains (COUNT,)``.
    """

    def __init__(self, inference: Contractor, gains: Floats | None = None) -> None:
        self._inference = inference
        self._gains = np.ones(COUNT) if gains is None else gains.astype(np.float64)
        self.target = EmotionState()
        self.intensities = Envelope(len(EMOTIONS))
        self._muscles = Envelope(len(MUSCLES))
        self._left = np.full(len(EMOTIONS), math.inf)
        self._fades = np.zeros(len(EMOTIONS))
        self._places = np.array([(i, row) for row, muscle in enumerate(MUSCLES) for i in indices_of(muscle)]).T

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

    def write(self, values: Doubles) -> None:
        """Put the contractions shown now into ``values`` ``(COUNT,)``."""
        values[self._places[0]] = self._gains[self._places[0]] * self._muscles.value[self._places[1]]

    def _advance(self, dt: float) -> None:
        self._left -= dt
        self.intensities.advance(dt)
        self._muscles.advance(dt)

    def _aim(self, intensities: Mapping[str, float], fade: float) -> None:
        self.target = EmotionState.of(intensities)
        self.intensities.move(self.target.array, fade)
        self._muscles.move(self._inference.contractions(self.target), fade)


class MuscleChannel:
    """Muscles and the jaw set one by one: such a muscle leaves whatever else moves it until it is released."""

    def __init__(self) -> None:
        self._value, self._weight = Envelope(COUNT), Envelope(COUNT)

    def set(self, name: str, contraction: float, fade: float) -> None:
        """Hold a muscle (both sides where none is named) at ``contraction``."""
        places = np.array(indices_of(name))
        unused = places[self._weight.value[places] == 0.0]
        self._value.move(contraction, 0.0, unused)
        self._value.move(contraction, fade, places)
        self._weight.move(1.0, fade, places)

    def release(self, fade: float, name: str | None = None) -> None:
        """Give one muscle, or all, back to the other channels."""
        self._weight.move(0.0, fade, slice(None) if name is None else np.array(indices_of(name)))

    @property
    def held(self) -> dict[str, float]:
        """The parameters that are set, and the contraction that each goes to."""
        return {NAMES[index]: float(self._value.target[index]) for index in np.flatnonzero(self._weight.target)}

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        self._value.advance(dt)
        self._weight.advance(dt)

    def write(self, values: Doubles) -> None:
        """Replace the muscles that are set in ``values`` ``(COUNT,)``."""
        weight = self._weight.value
        values *= 1.0 - weight
        values += weight * self._value.value


class TurnChannel:
    """The angles of the eyes (``gaze``) or of the head (``head``), in radians."""

    def __init__(self, kind: str) -> None:
        known = [known for known in PARAMETERS if known.kind == kind]
        self._places = np.array([parameter.index for parameter in known])
        self.angles = Envelope(len(known), [known.low for known in known], [known.high for known in known])

    def turn(self, angles: tuple[float, ...], fade: float) -> None:
        """Turn to ``angles`` in radians."""
        self.angles.move(angles, fade)

    def turn_one(self, name: str, angle: float, fade: float) -> None:
        """Turn by one parameter to ``angle`` in radians, the others going where they went."""
        self.angles.move(angle, fade, self._places == indices_of(name)[0])

    @property
    def targets(self) -> dict[str, float]:
        """The angle in radians that each parameter goes to."""
        return {NAMES[place]: angle for place, angle in zip(self._places, self.angles.target.tolist(), strict=True)}

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        self.angles.advance(dt)

    def write(self, values: Doubles) -> None:
        """Put the angles into ``values`` ``(COUNT,)``."""
        values[self._places] = self.angles.value
