"""The sink that measures the shown face in FAPs."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from agentface.conventions import Floats
from agentface.deform.geometry import FaceGeometry
from agentface.live.loop import Frame
from agentface.mpeg4.fap_stream import FapStream


class FapRecorder:
    """Measures each frame; then ``told`` gets its time in seconds.

    Args:
        measure: a geometry to FAPs ``(68,)``: ``FapMeter.measure``.
    """

    def __init__(
        self, measure: Callable[[FaceGeometry], Floats], told: Callable[[float], object] = lambda _: None
    ) -> None:
        self._measure, self._told = measure, told
        self._rows: list[Floats] = []

    def show(self, frame: Frame) -> None:
        """Measure one frame."""
        self._rows.append(np.array(self._measure(frame.geometry), np.float32))
        self._told(frame.time_s)

    def stream(self, rate: float, name: str) -> FapStream:
        """What was measured: all low-level FAPs, rounded to whole numbers."""
        return FapStream.measured(np.array(self._rows), rate, name)
