"""ARKit's weights that arrive one by one or frame by frame, and the poses that show them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Floats
from agentface.head.model import HeadModel
from agentface.motion.stream import STREAM_FADE_S, StreamChannel
from agentface.parameters import COUNT, NEUTRAL

if TYPE_CHECKING:
    from agentface.arkit.shape_solver import ArkitSolution, ShapeSolver

ARKIT_CHANNEL = "arkit"


class ArkitChannel(StreamChannel):
    """ARKit's face weights. The solver is made with the first frame."""

    def __init__(self) -> None:
        super().__init__()
        self._weights: dict[str, float] = {}
        self._solver: ShapeSolver | None = None
        self._found: ArkitSolution | None = None

    def change(self, model: HeadModel, weights: Mapping[str, float], fade: float = STREAM_FADE_S) -> None:
        """Some weights by name, beside those that are still shown."""
        if self.fresh:
            self._weights.clear()
        self._weights.update(weights)
        self.arrived(model, fade)

    def solved(self, model: HeadModel) -> tuple[Floats, Floats]:
        """The frame that waits, as values and weights ``(COUNT,)``, on a face."""
        if self._solver is None:
            from agentface.arkit.shape_solver import ShapeSolver

            self._solver = ShapeSolver(model)
        self._found = found = self._solver.solve_named(self._weights, self._found)
        moved = np.asarray(found.moves, np.bool_)
        return np.where(moved, found.pose.array, NEUTRAL), moved.astype(np.float32).reshape(COUNT)
