"""From a pose to a face: the deformers, one behind the other, and the protocol that every deformer keeps."""

from __future__ import annotations

from typing import Protocol

from agentface.anatomy.model import HeadModel
from agentface.deform.combine import Combiner, Method
from agentface.deform.eyelids import Eyelids
from agentface.deform.geometry import FaceGeometry
from agentface.deform.jaw import Jaw
from agentface.deform.lips import Lips
from agentface.deform.normals import NormalField
from agentface.deform.turns import PoseTransforms
from agentface.parameters import VECTOR_MUSCLES, FacePose, indices_of


class Deformer(Protocol):
    """Makes a face of a pose."""

    def deform(self, pose: FacePose) -> FaceGeometry:
        """The face in ``pose``; the result's arrays are overwritten by the next call."""


class GeometricDeformer:
    """The muscle-based face of Bui, Heylen and Nijholt.

    Vector muscles first, combined as ``combine`` says, on the face at rest; then lips, lids and jaw, which carry
    the displaced skin along; then the normals. ``compiled=False`` takes the numpy forms of the kernels, the same
    to 1e-7 m: ready at once, slow a frame.
    """

    def __init__(self, model: HeadModel, combine: Method = "parallel", *, compiled: bool = True) -> None:
        self._combiner = Combiner(model.vertices, model.muscles, combine, compiled=compiled)
        self._lips, self._eyelids, self._jaw = Lips(model), Eyelids(model), Jaw(model)
        self._turns = PoseTransforms(model)
        self._normals = NormalField(model.triangles, len(model.vertices), compiled=compiled)
        first = indices_of(VECTOR_MUSCLES[0])[0]
        self._muscles = slice(first, first + len(VECTOR_MUSCLES))
        self.geometry = FaceGeometry.at_rest(model.vertices, model.vertices)

    def deform(self, pose: FacePose) -> FaceGeometry:
        """The face in ``pose``; the result's arrays are overwritten by the next call."""
        geometry, values = self.geometry, pose.values
        self._combiner.apply(values[self._muscles], geometry.vertices)
        self._lips.apply(values, geometry.vertices)
        self._eyelids.apply(values, geometry.vertices)
        self._jaw.apply(values, geometry.vertices, geometry.jaw)
        self._normals.compute(geometry.vertices, geometry.normals)
        self._turns.eyes(values, geometry.eye_rotations)
        self._turns.head(values, geometry.head)
        return geometry
