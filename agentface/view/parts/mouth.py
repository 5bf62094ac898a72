"""Teeth and tongue, and how much light the lips let in."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.head.ring_names import LipRing
from agentface.head.rings import RingHalves
from agentface.view.gl.drawn_mesh import DrawnMesh
from agentface.view.parts.rigid import RigidPart, rigid_mesh
from agentface.view.parts.teeth import evened_facing, meeting_places, tones

PARTS = "teeth_upper", "teeth_lower", "tongue"
SHADED = 0.22  # of the light on the lower jaw, which the upper lip and the nose keep off
_PLACES = np.linspace(-0.6, 0.6, 7)  # where the gap is looked at: parts of half the mouth's width, to the left
_PURSED = 0.1  # of the mouth's width at rest, by which it is narrower where it is all pursed
_MIDDLE = len(_PLACES) // 2


class Mouth:
    """What is behind the lips, on the GPU."""

    def __init__(self, context: Any, program: Any, model: HeadModel) -> None:
        self._program = program
        self._parts = {name: RigidPart(context, program, mouth_mesh(model, name)) for name in PARTS}
        self._opening = MouthOpening(model)

    def draw(self, geometry: FaceGeometry) -> None:
        """Draw it as ``geometry`` has it."""
        self._program["shaded"].value = 0.0
        self._parts["teeth_upper"].draw(geometry.head)
        self._program["shaded"].value = SHADED
        self._parts["tongue"].reshape(geometry.tongue)
        for name in ("teeth_lower", "tongue"):
            self._parts[name].draw(geometry.head @ geometry.jaw)

    def opening(self, geometry: FaceGeometry) -> dict[str, object]:
        """The uniforms of ``shaders/mouth.glsl``."""
        return self._opening.uniforms(geometry.vertices)


class MouthOpening:
    """How far the mouth is open, by the vertices of the lips."""

    def __init__(self, model: HeadModel) -> None:
        ring = model.lips.rings[LipRing.LINING]
        self._corners = ring.upper[0], ring.upper[-1]
        touching = model.lips.rings[: LipRing.RED + 1]
        self._half_at_rest = self._half(model.vertices)
        pairs = np.array([_facing(model.vertices[:, 0], ring, self._half_at_rest) for ring in touching])
        self._upper, self._lower = pairs[..., 0], pairs[..., 1]
        self._bow = 1.0 - _PLACES**2  # an opening between two bows
        self._at_rest = self._gap(*self._edges(model.vertices))
        self._opened = 0.12 * model.landmarks.eye_separation

    def record(self) -> dict[str, Any]:
        """What the same numbers are made of elsewhere."""
        return {
            "corners": np.array(self._corners, np.int32),
            "upper": self._upper,
            "lower": self._lower,
            "bow": self._bow,
            "gap_at_rest": self._at_rest,
            "half_at_rest": self._half_at_rest,
            "opened": self._opened,
            "pursed": _PURSED,
        }

    def uniforms(self, vertices: Floats) -> dict[str, object]:
        """The uniforms of ``shaders/mouth.glsl``, with the skin at ``vertices (V, 3)`` m."""
        half = self._half(vertices)
        front = 0.5 * float(vertices[self._upper[0], 2].mean() + vertices[self._lower[0], 2].mean())
        corner = vertices[list(self._corners), 1:].mean(0)
        upper, lower = self._edges(vertices)
        middle, gap = 0.5 * (float(upper[_MIDDLE]) + float(lower[_MIDDLE])), self._gap(upper, lower)
        return {
            "mouth_light": self._light(gap),
            "mouth_opening": (middle + 0.5 * gap, middle - 0.5 * gap, abs(half), front),
            "mouth_pursed": min(max((1.0 - half / self._half_at_rest) / _PURSED, 0.0), 1.0),
            "mouth_bow": (front - float(corner[1]), float(corner[0]) - middle),
        }

    def _half(self, vertices: Floats) -> float:
        return 0.5 * float(vertices[self._corners[0], 0] - vertices[self._corners[1], 0])

    def _edges(self, vertices: Floats) -> tuple[Floats, Floats]:
        """Heights of the lips' edges by column, m: of the rings that may touch, where least light comes through."""
        return vertices[self._upper, 1].min(axis=0), vertices[self._lower, 1].max(axis=0)

    def _light(self, gap: float) -> float:
        """The part of the light that reaches the teeth: all through a mouth open by a finger, little through a slit."""
        return min(1.0, 0.03 + 0.97 * max(0.0, (gap - self._at_rest) / self._opened))

    def _gap(self, upper: Floats, lower: Floats) -> float:
        """How high the middle of an opening between two bows is that lets through as much as these edges do, m."""
        return float(np.maximum(upper - lower, 0.0) @ self._bow / (self._bow @ self._bow))


def _facing(across: Floats, ring: RingHalves, half: float) -> list[tuple[int, int]]:
    """At each of the places a vertex of the upper lip and the one of the lower lip that lies across from it at rest.

    The lips have columns of their own: of a smile, or of corners that hang, those of the same number see a gap where
    there is none. The lower lip's are the sparser.
    """
    lower = [min(ring.lower, key=lambda v: abs(across[v] - at * half)) for at in -_PLACES]
    return [(min(ring.upper, key=lambda v: abs(across[v] - across[below])), below) for below in lower]


def mouth_mesh(model: HeadModel, name: str) -> DrawnMesh:
    """One of :data:`PARTS` for ``shaders/part.vert.glsl``."""
    mesh = model.parts[name]
    material = mesh.attributes["_MATERIAL"].astype(np.float32) / np.float32(255)
    positions = mesh.attributes["POSITION"]
    detail = meeting_places(positions, mesh.triangles, material[:, 0])
    material[:, 3] = tones(positions, mesh.triangles, material[:, 0])
    drawn = rigid_mesh(positions, mesh.triangles, material, detail)
    drawn.fields["facing"][:] = evened_facing(positions, drawn.fields["facing"], material[:, 0])
    return drawn
