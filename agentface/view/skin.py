"""The skin on the GPU: one texture a frame, from which everything that lies on the skin finds its place."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Floats
from agentface.deform.geometry import FaceGeometry
from agentface.errors import InvalidValueError
from agentface.view.complexion import blurred, complexion
from agentface.view.refine import refine, unrefined, vertex_normals
from agentface.view.shirt import uncovered

_COLUMNS = 256
_BLUR = 14


class SkinFields:
    """The texture ``skin_fields`` of ``shaders/surface.glsl``: positions and wrinkles, then normals."""

    def __init__(self, context: Any, vertex_count: int) -> None:
        self.count = vertex_count
        rows = -(-vertex_count // _COLUMNS)
        self._texels = np.zeros((2, rows * _COLUMNS, 4), np.float32)
        self.texture = context.texture((_COLUMNS, 2 * rows), 4, dtype="f4")
        self.texture.filter = (context.NEAREST, context.NEAREST)

    def update(self, geometry: FaceGeometry) -> None:
        """Upload a frame; raises InvalidValueError for a geometry of another mesh."""
        expected = (self.count, 3)
        for name in ("vertices", "smooth_normals"):
            if getattr(geometry, name).shape != expected:
                raise InvalidValueError(
                    f"geometry.{name}", f"an array of shape {expected}", getattr(geometry, name).shape
                )
        self._texels[0, : self.count, :3] = geometry.vertices
        self._texels[0, : self.count, 3] = geometry.wrinkles
        self._texels[1, : self.count, :3] = geometry.smooth_normals
        self.texture.write(self._texels)


class Skin:
    """The skin's static buffers, as it is or (``fine``) with every triangle cut into four curved ones."""

    def __init__(
        self, context: Any, program: Any, model: HeadModel, covered: Floats, lit: Floats, *, fine: bool
    ) -> None:
        count = len(model.vertices)
        triangles = uncovered(model)
        mesh = refine(triangles, count) if fine else unrefined(triangles, count)
        normals = vertex_normals(model.vertices, model.triangles)
        fields: tuple[tuple[str, Floats], ...] = (
            ("rest", model.vertices),
            ("soft_normal", blurred(normals, model.triangles, _BLUR)),
            ("rest_normal", normals),
            ("material", model.material),
            ("complexion", complexion(model, covered)),
            ("ambient", model.shade[:, :1]),
            ("lit_at_rest", lit),
        )
        layout = [(context.buffer(mesh.ends.tobytes()), "2i", "ends")]
        for name, field in fields:
            if name not in program:  # a compiler drops what a shader does not use
                continue
            layout.append((context.buffer(mesh.mean(field).tobytes()), f"{field.shape[1]}f", name))
        corners = context.buffer(mesh.triangles.astype(np.int32).tobytes())
        self.array = context.vertex_array(program, layout, corners)

    def draw(self) -> None:
        """Draw it where ``SkinFields`` has it."""
        self.array.render()
