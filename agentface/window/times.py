"""How long the parts of the last frames took."""

from __future__ import annotations

from collections import deque

import numpy as np

from agentface.conventions import Floats

FRAMES = 120


class Times:
    """Milliseconds of the last ``FRAMES`` frames: the deformation, the drawing, and from one frame to the next."""

    def __init__(self) -> None:
        self.deform_ms = self.draw_ms = 0.0
        self.dropped = 0
        """The frames that came while an earlier one was drawn."""
        self._totals: deque[float] = deque([0.0] * FRAMES, maxlen=FRAMES)

    def note(self, deform_s: float, draw_s: float, total_s: float) -> None:
        """A frame took so many seconds."""
        # a tenth of the news a frame: digits that can be read
        self.deform_ms += 0.1 * (1000.0 * deform_s - self.deform_ms)
        self.draw_ms += 0.1 * (1000.0 * draw_s - self.draw_ms)
        self._totals.append(1000.0 * total_s)

    @property
    def totals_ms(self) -> Floats:
        """``(FRAMES,)`` float32, the last frame last; 0 before the first."""
        return np.array(self._totals, np.float32)

    @property
    def total_ms(self) -> float:
        """The mean of the last second or so."""
        known = [total for total in list(self._totals)[-30:] if total > 0.0]
        return sum(known) / len(known) if known else 0.0
