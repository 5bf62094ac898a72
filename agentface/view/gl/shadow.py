"""The key light's shadow: a picture of depths of the frame, and what it says of the face at rest."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel
from agentface.mesh.refine import unrefined

_SIDE = 112
_CLEARANCE = 0.0035
_SOFTNESS = 0.0045
_SLACK = 0.0050
_STEEPEST = 3.0
"""Slope of the skin as the light sees it up to which its own depths beside a vertex are no shadow on it."""


class KeyShadow:
    """The key light's picture of depths."""

    def __init__(self, context: Any, program: Any, model: HeadModel) -> None:
        self.context = context
        self.depth = context.depth_texture((_SIDE, _SIDE))
        self.depth.compare_func = "<="
        self.depth.repeat_x = self.depth.repeat_y = False
        self.depth.filter = (context.LINEAR, context.LINEAR)
        self.target = context.framebuffer(depth_attachment=self.depth)
        ends = unrefined(model.triangles, len(model.vertices)).ends
        layout = [(context.buffer(ends.tobytes()), "2i", "ends")]
        self.outline = context.vertex_array(program, layout, context.buffer(model.triangles.tobytes()))

    def draw(self) -> None:
        """Draw the skin of the frame."""
        self.target.use()
        self.target.clear(depth=1.0)
        self.context.enable_only(self.context.DEPTH_TEST)
        self.outline.render()

    def use(self, slot: int) -> None:
        """Bind the depths to a texture slot."""
        self.depth.use(slot)

    def lit(self, vertices: Floats, normals: Floats, projection: Doubles) -> Floats:
        """``(V, 1)`` 0..1: how much of the key light the vertices get in the picture drawn last, with a soft edge."""
        depths = np.frombuffer(self.depth.read(), np.float32).reshape(_SIDE, _SIDE)
        lifted = vertices + _CLEARANCE * normals
        place = 0.5 * (lifted @ projection[:3, :3].T + projection[:3, 3]) + 0.5
        reach = _SOFTNESS * 0.5 * np.linalg.norm(projection[0, :3]) * _SIDE
        total = np.zeros(len(vertices))
        axis = projection[2, :3] / np.linalg.norm(projection[2, :3])
        facing = np.abs(normals @ axis)
        slope = np.minimum(np.sqrt(np.maximum(1.0 - facing**2, 0.0)) / np.maximum(facing, 1e-3), _STEEPEST)
        slack = _SLACK + 0.5 * np.linalg.norm(projection[2, :3]) * _SOFTNESS * slope
        steps = np.linspace(-reach, reach, 7)
        for right in steps:
            for up in steps:
                columns, rows = (np.clip(place[:, :2] * _SIDE + [right, up], 0, _SIDE - 1)).astype(int).T
                total += place[:, 2] - slack <= depths[rows, columns]
        return (total[:, None] / len(steps) ** 2).astype(np.float32)
