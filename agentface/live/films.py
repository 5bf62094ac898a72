"""The sink of a film."""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from agentface.conventions import Bytes
from agentface.deform.geometry import FaceGeometry
from agentface.live.loop import Frame


class FilmWriter(Protocol):
    """What takes a film's pictures: ``VideoWriter`` and ``SequenceWriter`` of :mod:`agentface.io`."""

    def add(self, image: Bytes, time_s: float) -> None:
        """Show ``image`` from ``time_s`` on."""

    def close(self) -> None:
        """Write what is left."""


class FilmSink:
    """Draws each frame and writes it; then ``told`` gets its time in seconds."""

    def __init__(
        self,
        draw: Callable[[FaceGeometry], Bytes],
        writer: FilmWriter,
        told: Callable[[float], object] = lambda _: None,
    ) -> None:
        self._draw, self._writer, self._told = draw, writer, told

    def show(self, frame: Frame) -> None:
        """Add one frame to the film."""
        self._writer.add(self._draw(frame.geometry), frame.time_s)
        self._told(frame.time_s)
