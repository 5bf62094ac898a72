"""The bone under a face, seen through its skin."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.mesh.normals import vertex_normals
from agentface.view.gl.programs import Programs
from agentface.view.skin.uncovered import uncovered

_INSIDE = 0.02
_JAWS = {"teeth_upper": 0.0, "teeth_lower": 1.0}
"""The teeth, and how far they go with the jaw."""


class Bone(NamedTuple):
    """A bone under a face.

    Attributes:
        points: ``(V, 3)`` float32 m, with the jaw closed.
        triangles: ``(T, 3)`` int32, counter-clockwise seen from outside.
        jaw_weights: ``(V,)`` float32 0..1, how far each point goes with the jaw.
        tint: ``(V,)`` float32 0..1: 0 the colour of bone, 0.5 amber, 1 red.
    """

    points: Floats
    triangles: Indices
    jaw_weights: Floats
    tint: Floats


class BoneView:
    """Draws a bone with the teeth in it, and the skin as a film over it."""

    def __init__(self, context: Any, programs: Programs, model: HeadModel) -> None:
        self._program = programs["bone"]
        self._teeth = [_Solid(context, self._program, _teeth(model, *jaw)) for jaw in _JAWS.items()]
        self._bone: _Solid | None = None
        self._context = context
        triangles = uncovered(model)
        outside = ~(model.material[triangles, 1] > _INSIDE).any(axis=1)
        corners = context.buffer(triangles[outside].astype(np.int32).tobytes())
        self._film = context.vertex_array(programs["film"], [], corners)

    def draw(self, geometry: FaceGeometry, bone: Bone) -> None:
        """Draw the bone, solid; ``geometry`` opens its jaw. The next bone has the same triangles."""
        if self._bone is None:
            self._bone = _Solid(self._context, self._program, bone)
        self._bone.update(bone)
        self._program["jaw"].write(np.ascontiguousarray(geometry.jaw.T, np.float32).tobytes())
        for part in (self._bone, *self._teeth):
            part.array.render()

    def draw_film(self, context: Any, target: Any) -> None:
        """Draw the skin over what is in the framebuffer ``target``, where the texture ``skin_fields`` has it."""
        context.enable_only(context.DEPTH_TEST | context.CULL_FACE)
        target.color_mask = (False,) * 4
        target.use()
        self._film.render()  # of skin behind skin the nearest alone is seen
        target.color_mask = (True,) * 4
        target.use()
        context.enable(context.BLEND)
        context.blend_func = context.SRC_ALPHA, context.ONE_MINUS_SRC_ALPHA, context.ONE, context.ONE_MINUS_SRC_ALPHA
        context.depth_func = "<="
        self._film.render()
        context.depth_func = "<"


class _Solid:
    """A bone on the GPU."""

    def __init__(self, context: Any, program: Any, bone: Bone) -> None:
        self._bone = bone
        self._places, self._tint = context.buffer(_places(bone).tobytes()), context.buffer(bone.tint.tobytes())
        layout = [(self._places, "3f 3f 1f", "place", "facing", "opening"), (self._tint, "1f", "tint")]
        self.array = context.vertex_array(program, layout, context.buffer(bone.triangles.astype(np.int32).tobytes()))

    def update(self, bone: Bone) -> None:
        """Upload what of it is new."""
        if bone.points is not self._bone.points:
            self._places.write(_places(bone).tobytes())
        if bone.tint is not self._bone.tint:
            self._tint.write(bone.tint.tobytes())
        self._bone = bone


def _places(bone: Bone) -> Floats:
    facing = vertex_normals(bone.points, bone.triangles)
    return np.column_stack([bone.points, facing, bone.jaw_weights]).astype(np.float32)


def _teeth(model: HeadModel, name: str, weight: float) -> Bone:
    mesh = model.parts[name]
    points = mesh.attributes["POSITION"]
    count = len(points)
    return Bone(points, mesh.triangles, np.full(count, weight, np.float32), np.zeros(count, np.float32))
