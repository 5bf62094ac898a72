"""The angles of eyes and head."""

from __future__ import annotations

from typing import Literal

from agentface.conventions import Doubles
from agentface.motion.envelope import Envelope
from agentface.parameters import PARAMETERS


class TurnChannel:
    """The angles of the eyes (``gaze``) or of the head (``head``), in radians."""

    def __init__(self, kind: Literal["gaze", "head"], *, compiled: bool = False) -> None:
        turned = [known for known in PARAMETERS if known.kind == kind]
        self.names = tuple(known.name for known in turned)
        low, high = [known.low for known in turned], [known.high for known in turned]
        self.angles = Envelope(len(turned), low, high, compiled=compiled)

    def turn(self, angles: tuple[float, ...], fade: float) -> None:
        """Turn to ``angles`` in radians."""
        self.angles.move(angles, fade)

    def turn_one(self, name: str, angle: float, fade: float) -> None:
        """Turn one parameter to ``angle`` in radians; the others go on to where they went."""
        self.angles.move(angle, fade, [self.names.index(name)])

    def release(self, fade: float) -> None:
        """Turn straight ahead."""
        self.angles.move(0.0, fade)

    @property
    def targets(self) -> dict[str, float]:
        """The angle in radians that each parameter goes to."""
        return dict(zip(self.names, self.angles.target.tolist(), strict=True))

    def advance(self, dt: float) -> None:
        """Let ``dt`` seconds pass."""
        self.angles.advance(dt)

    def write(self, values: Doubles, weights: Doubles) -> bool:
        """The angles now."""
        if self.angles.resting:
            return False
        values[:] = self.angles.value
        return True
