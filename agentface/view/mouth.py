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
        touching = model.lips.rings[: LipRing.RED + 1]
        self._upper, self._lower = (
            np.array([half[len(half) // 2 - 2 : len(half) // 2 + 3] for half in halves])
            for halves in ([ring.upper for ring in touching], [ring.lower for ring in touching])
        )

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
        upper, lower = self._edges(vertices)
        half = 0.5 * float(vertices[self._corners[0], 0] - vertices[self._corners[1], 0])
        front = 0.5 * float(vertices[self._upper[0], 2].mean() + vertices[self._lower[0], 2].mean())
        corner = vertices[list(self._corners), 1:].mean(0)
        return {
            "mouth_light": self.light(geometry),
            "mouth_opening": (upper, lower, abs(half), front),
            "mouth_bow": (front - float(corner[1]), float(corner[0]) - 0.5 * (upper + lower)),
        }

    def _edges(self, vertices: Floats) -> tuple[float, float]:
        """Heights of the lips' edges in the middle, m: of the rings that may touch, where least light comes through."""
        upper, lower = (vertices[rings, 1].mean(axis=1) for rings in (self._upper, self._lower))
        return float(upper.min()), float(lower.max())

    def _lip_gap(self, vertices: Floats) -> float:
        upper, lower = self._edges(vertices)
        return upper - lower


def _part(context: Any, program: Any, model: HeadModel, name: str) -> RigidPart:
    mesh = model.parts[name]
    material = mesh.attributes["_MATERIAL"].astype(np.float32) / np.float32(255)
    material[:, 3] = 0.0
    positions = mesh.attributes["POSITION"]
    detail = crown_places(positions, mesh.triangles, material[:, 0])
    return RigidPart(context, program, positions, mesh.triangles, material, detail)
