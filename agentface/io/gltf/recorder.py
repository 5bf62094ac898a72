"""The sink that keeps of a running face what an animation needs."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel
from agentface.io.gltf.face_parts import released
from agentface.io.gltf.surface import Surface
from agentface.live.loop import Frame


class RowTaker(Protocol):
    """Takes the movements of the surface, frame by frame."""

    def add(self, row: Doubles) -> None:
        """Take ``(3 N,)`` m."""


class _Stand(NamedTuple):
    head: Floats
    eyes: Floats
    thrusts: Floats
    shoulders: Floats


class SurfaceRecorder:
    """Gives each frame's movement to ``taker``, and keeps how head, eyes and shoulders stand.

    Attributes:
        told: gets the time of each frame in seconds.
        times_s: ``(T,)`` seconds.
        heads: ``(T, 3, 3)`` the head's turns.
        eyes: ``(T, 2, 3, 3)`` the eyes'.
        thrusts: ``(T, 2)`` m, how far the eyes come forward.
        shoulders: ``(T, 4, 4)``, what moves them.
    """

    def __init__(self, model: HeadModel, surface: Surface, taker: RowTaker) -> None:
        self._model, self._surface, self._taker = model, surface, taker
        self.told: Callable[[float], object] = lambda _: None
        self._times: list[float] = []
        self._stands: list[_Stand] = []

    def show(self, frame: Frame) -> None:
        """Take one frame."""
        geometry = frame.geometry
        self._taker.add(self._surface.row(released(self._model, geometry)))
        self._times.append(frame.time_s)
        stand = geometry.head[:3, :3], geometry.eye_rotations, geometry.eye_thrust, geometry.shoulders
        self._stands.append(_Stand(*(array.copy() for array in stand)))
        self.told(frame.time_s)

    def __len__(self) -> int:
        return len(self._times)

    @property
    def times_s(self) -> Doubles:
        """``(T,)``."""
        return np.array(self._times)

    @property
    def heads(self) -> Floats:
        """``(T, 3, 3)``."""
        return np.stack([stand.head for stand in self._stands])

    @property
    def eyes(self) -> Floats:
        """``(T, 2, 3, 3)``."""
        return np.stack([stand.eyes for stand in self._stands])

    @property
    def thrusts(self) -> Floats:
        """``(T, 2)`` m."""
        return np.stack([stand.thrusts for stand in self._stands])

    @property
    def shoulders(self) -> Floats:
        """``(T, 4, 4)``."""
        return np.stack([stand.shoulders for stand in self._stands])
