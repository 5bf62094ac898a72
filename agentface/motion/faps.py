"""FAPs that arrive frame by frame, and the poses that show them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from agentface.conventions import Floats
from agentface.head.model import HeadModel
from agentface.motion.stream import STREAM_FADE_S, StreamChannel
from agentface.mpeg4.fap_stream import EXPRESSION, EXPRESSION_FIELDS, VISEME, VISEME_FIELDS, Mask
from agentface.mpeg4.fap_table import FAP_COUNT
from agentface.parameters import COUNT, NEUTRAL

if TYPE_CHECKING:
    from agentface.mpeg4.fap_player import FapPlayer
    from agentface.mpeg4.fap_solver import FapSolution

_NO_FIELDS = (0,) * len(VISEME_FIELDS), (0,) * len(EXPRESSION_FIELDS)


class FapChannel(StreamChannel):
    """FAPs of MPEG-4. The solver is made with the first frame."""

    def __init__(self) -> None:
        super().__init__()
        self._values, self._mask = np.zeros(FAP_COUNT), np.zeros(FAP_COUNT, np.bool_)
        self._fields: tuple[tuple[int, ...], tuple[int, ...]] = _NO_FIELDS
        self._player: FapPlayer | None = None
        self._found: FapSolution | None = None

    def change(self, model: HeadModel, faps: Mapping[int, float], fade: float = STREAM_FADE_S) -> None:
        """Some low-level FAPs by number, beside those that are still shown."""
        if self.fresh:
            self._mask[:] = False
            self._fields = _NO_FIELDS
        self._put(model, faps, fade)

    def frame(
        self,
        model: HeadModel,
        faps: Mapping[int, float],
        viseme: tuple[int, ...] | None = None,
        expression: tuple[int, ...] | None = None,
        fade: float = STREAM_FADE_S,
    ) -> None:
        """A whole frame: low-level FAPs by number, the fields of FAP 1 and of FAP 2; what it does not name is free."""
        self._mask[:] = False
        self._mask[[VISEME, EXPRESSION]] = viseme is not None, expression is not None
        self._fields = viseme or _NO_FIELDS[0], expression or _NO_FIELDS[1]
        self._put(model, faps, fade)

    def solved(self, model: HeadModel) -> tuple[Floats, Floats]:
        """The frame that waits, as values and weights ``(COUNT,)``, on a face."""
        if self._player is None:
            from agentface.mpeg4.fap_player import FapPlayer
            from agentface.mpeg4.fap_solver import FapSolver

            self._player = FapPlayer(FapSolver(model))
        found = self._player.play(self._values, self._mask, *self._fields, previous=self._found)
        self._found = found
        high: Mask = np.logical_and(self._mask[: EXPRESSION + 1].any(), found.pose.array != NEUTRAL)
        moved = found.moves | high
        return np.where(moved, found.pose.array, NEUTRAL), moved.astype(np.float32).reshape(COUNT)

    def _put(self, model: HeadModel, faps: Mapping[int, float], fade: float) -> None:
        for number, value in faps.items():
            self._values[number - 1], self._mask[number - 1] = value, True
        self.arrived(model, fade)
