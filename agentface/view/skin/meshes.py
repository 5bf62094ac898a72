"""The skin on the GPU: one texture a frame, from which everything that lies on the skin finds its place."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Floats, Indices
from agentface.deform.geometry import FaceGeometry
from agentface.errors import InvalidValueError
from agentface.head.model import HeadModel
from agentface.mesh.refine import Refined, refine, unrefined
from agentface.view.gl.drawn_mesh import DrawnMesh
from agentface.view.skin.complexion import blurred, softened_corners
from agentface.view.skin.ears import sharp_ears
from agentface.view.skin.fine_lips import FineLips
from agentface.view.skin.uncovered import uncovered

_COLUMNS = 256
_BLUR, _BLUR_EARS = 14, 3


class SkinFields:
    """The texture ``skin_fields`` of ``shaders/surface.glsl``: positions and wrinkles, then normals.

    The vertices of ``lips`` come behind those of the skin.
    """

    def __init__(self, context: Any, model: HeadModel, lips: FineLips) -> None:
        self.count, self._lips = len(model.vertices), lips
        rest = FaceGeometry.at_rest(model)
        self._shapes = {name: array.shape for name, array in rest.arrays()._asdict().items()}
        rows = -(-(self.count + lips.count) // _COLUMNS)
        self._texels = np.zeros((2, rows * _COLUMNS, 4), np.float32)
        self.texture = context.texture((_COLUMNS, 2 * rows), 4, dtype="f4")
        self.texture.filter = (context.NEAREST, context.NEAREST)

    def update(self, geometry: FaceGeometry) -> None:
        """Upload a frame; raises InvalidValueError for a geometry of another mesh."""
        for name, shape in self._shapes.items():
            if getattr(geometry, name).shape != shape:
                raise InvalidValueError(f"geometry.{name}", f"an array of shape {shape}", getattr(geometry, name).shape)
        self._texels[0, : self.count, :3] = geometry.vertices
        self._texels[0, : self.count, 3] = geometry.wrinkles
        self._texels[1, : self.count, :3] = geometry.smooth_normals
        self.texture.write(self._texels)

    def update_lips(self, geometry: FaceGeometry) -> None:
        """Upload the fine lips of the frame."""
        behind = slice(self.count, self.count + self._lips.count)
        self._texels[:, behind, :3] = self._lips.update(geometry.vertices, geometry.smooth_normals)
        first, rows = self.count // _COLUMNS, self._texels.shape[1] // _COLUMNS
        for half, texels in enumerate(self._texels):
            part = texels[first * _COLUMNS :]
            self.texture.write(part, viewport=(0, half * rows + first, _COLUMNS, rows - first))


class SkinMeshes:
    """The skin's static fields, as it is and finer; drawn where ``SkinFields`` has it.

    ``dressed``: those that the look makes, ``(V, 1..4)`` by the names of ``shaders/skin_place.glsl``. ``extended``: all
    of them, with the fine lips behind.
    """

    def __init__(self, model: HeadModel, lips: FineLips, dressed: dict[str, Floats]) -> None:
        self._model, self._lips, self._triangles = model, lips, uncovered(model)
        fields = {
            "rest": model.vertices,
            "soft_normal": _soft_normals(model),
            "rest_normal": model.normals,
            "material": softened_corners(model),
            **dressed,
        }
        self._fields = fields
        self.extended = {name: lips.extended(field) for name, field in fields.items()}

    def coarse(self) -> DrawnMesh:
        """The skin as it is."""
        return _drawn(unrefined(self._triangles, len(self._model.vertices)), self._fields)

    def fine(self, longest_m: float) -> DrawnMesh:
        """With edges longer than ``longest_m`` cut and curved, and the lips on their spline."""
        return _drawn(self.refined(longest_m), self.extended)

    def refined(self, longest_m: float) -> Refined:
        """How :meth:`fine` is cut: its vertices between those of :attr:`extended`."""

        def cut(edges: Indices) -> npt.NDArray[np.bool_]:
            a, b = self._model.vertices[edges[:, 0]], self._model.vertices[edges[:, 1]]
            return np.asarray((np.linalg.norm(a - b, axis=1) > longest_m) | self._lips.has_edges(edges))

        return self._lips.mesh(refine(self._triangles, len(self._model.vertices), cut))


def _soft_normals(model: HeadModel) -> Floats:
    sharp = blurred(model.normals, model.triangles, _BLUR_EARS)
    return sharp_ears(model, sharp, blurred(sharp, model.triangles, _BLUR - _BLUR_EARS))


def _drawn(mesh: Refined, fields: dict[str, Floats]) -> DrawnMesh:
    return DrawnMesh.of(mesh.triangles, ends=mesh.ends, **{name: mesh.mean(field) for name, field in fields.items()})


class Skin:
    """A mesh of the skin, smooth or with the wrinkles that the mesh has no vertices for."""

    def __init__(self, context: Any, programs: tuple[Any, Any], mesh: DrawnMesh) -> None:
        self._context = context
        self._arrays = [mesh.array(context, program, partly=True) for program in programs]

    def draw(self, *, wrinkled: bool) -> None:
        """Draw what faces the camera of it, where ``SkinFields`` has it."""
        self._context.enable(self._context.CULL_FACE)
        self._arrays[wrinkled].render()
        self._context.disable(self._context.CULL_FACE)
