"""A deformer with memory that tests register: its vertices follow the geometric face's, late."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from agentface.deform.geometry import FaceGeometry
from agentface.deform.pipeline import GeometricDeformer
from agentface.deform.protocol import register
from agentface.head.model import HeadModel
from agentface.parameters import FacePose

LATE_S = 0.1


class Jelly:
    """Goes towards the pose with a time constant of :data:`LATE_S`."""

    def __init__(self, model: HeadModel, *, compiled: bool = True) -> None:
        self._still = GeometricDeformer(model, compiled=compiled)
        self._shown = self._still.at(FacePose())

    def reset(self, pose: FacePose) -> None:
        self._shown = self.at(pose)

    def step(self, pose: FacePose, dt: float) -> FaceGeometry:
        target = self._still.at(pose)
        part = np.float32(1.0 - np.exp(-dt / LATE_S))
        late = self._shown.vertices + part * (target.vertices - self._shown.vertices)
        for own, new in zip(self._shown.arrays(), target.arrays(), strict=True):
            own[...] = new
        self._shown.vertices[...] = late
        return self._shown

    def at(self, pose: FacePose) -> FaceGeometry:
        return self._still.at(pose)


@contextmanager
def registered() -> Iterator[str]:
    """The name under which it is known meanwhile."""
    take_away = register("jelly", Jelly)
    try:
        yield "jelly"
    finally:
        take_away()
