"""Teeth and tongue, and how much light the lips let in."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.anatomy.ring_names import LipRing
from agentface.conventions import Floats
from agentface.deform.geometry import FaceGeometry
from agentface.view.parts import RigidPart
from agentface.view.teeth import crown_places

_SHADED = 0.25  # of the light on the lower jaw, which the upper lip and the nose keep off


class Mouth:
    """What is behind the lips, on the GPU."""

    def __init__(self, context: Any, program: Any, model: HeadModel) -> None:
        self._model, self._program = model, program
        self._parts = {name: _part(context, program, model, name) for name in ("teeth_upper", "teeth_lower", "tongue")}
        ring = model.lips.rings[LipRing.LINING]
        self._corners = ring.upper[0], ring.upper[-1]
        self._lips = [half[len(half) // 2 - 2 : len(half) // 2 + 3] for half in (ring.upper, ring.lower)]

    def draw(self, geometry: FaceGeometry) -> None:
        """Draw it as ``geometry`` has it."""
        self._program["shaded"].value = 0.0
        self._parts["teeth_upper"].draw(geometry.head)
        self._program["shaded"].value = _SHADED
        for name in ("teeth_lower", "tongue"):
            self._parts[name].draw(geometry.head @ geometry.jaw)

    def light(self, geometry: FaceGeometry) -> float:
        """The part of the light that reaches the teeth: all through a mouth open by a finger, little through a slit."""
        wider = self._lip_gap(geometry.vertices) - self._lip_gap(self._model.vertices)
        opened = wider / (0.12 * self._model.landmarks.eye_separation)
        return min(1.0, 0.03 + 0.97 * max(0.0, opened))

    def opening(self, geometry: FaceGeometry) -> dict[str, object]:
        """The uniforms of ``shaders/mouth.glsl``."""
        vertices = geometry.vertices
        upper, lower = (vertices[ring] for ring in self._lips)
        half = 0.5 * float(vertices[self._corners[0], 0] - vertices[self._corners[1], 0])
        front = 0.5 * float(upper[:, 2].mean() + lower[:, 2].mean())
        corner = vertices[list(self._corners), 1:].mean(0)
        middle = 0.5 * float(upper[:, 1].mean() + lower[:, 1].mean())
        return {
            "mouth_light": self.light(geometry),
            "mouth_opening": (float(upper[:, 1].mean()), float(lower[:, 1].mean()), abs(half), front),
            "mouth_bow": (front - float(corner[1]), float(corner[0]) - middle),
        }

    def _lip_gap(self, vertices: Floats) -> float:
        upper, lower = (vertices[ring, 1] for ring in self._lips)
        return float(upper.mean() - lower.mean())


def _part(context: Any, program: Any, model: HeadModel, name: str) -> RigidPart:
    mesh = model.parts[name]
    material = mesh.attributes["_MATERIAL"].astype(np.float32) / np.float32(255)
    material[:, 3] = 0.0
    positions = mesh.attributes["POSITION"]
    detail = crown_places(positions, mesh.triangles, material[:, 0])
    return RigidPart(context, program, positions, mesh.triangles, material, detail)
