"""What a pose would show: the geometric face as far as some numbers are read off it, without pictures' normals.

Solvers look at many poses a frame. :class:`PlainSight` is the numpy form, whole frames and slow; the compiled twin,
:mod:`agentface.mpeg4.sight_compiled`, leaves out what none of the numbers can tell.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.deform.pipeline import GeometricDeformer
from agentface.head.model import HeadModel
from agentface.mpeg4.readings import Readings, read
from agentface.parameters import FacePose


class Features(NamedTuple):
    """N numbers that are linear in C readings of the skin: what a solver is asked to reach.

    Attributes:
        readings: what is read.
        matrix: ``(N, C)`` float64: features are ``matrix @ readings``.
    """

    readings: Readings
    matrix: Doubles


class PlainSight:
    """Looks at poses of a face by numpy forms."""

    def __init__(self, model: HeadModel, features: Features) -> None:
        self._deformer = GeometricDeformer(model, compiled=False)
        self._features = features
        self._numbers = np.empty(len(features.readings.kind))

    def look(self, values: Floats, out: Doubles) -> None:
        """Write the features of the pose ``values (COUNT,)`` into ``out (N,)``."""
        read(self._features.readings, self._deformer.step(FacePose(values), 0.0).arrays(), self._numbers)
        out[:] = self._features.matrix @ self._numbers


def look(sight: PlainSight, values: Floats, out: Doubles) -> None:
    """Write the features of the pose ``values (COUNT,)`` into ``out (N,)``."""
    sight.look(values, out)
