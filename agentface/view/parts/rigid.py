"""Draws the meshes of one piece: teeth, tongue, cloth and eyeballs."""

from __future__ import annotations

from typing import Any

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel
from agentface.head.ring_names import LidRing
from agentface.mesh.normals import vertex_normals
from agentface.view.gl.drawn_mesh import DrawnMesh

IRIS_RADIUS = 0.37
"""In radii of the eyeball."""


class RigidPart:
    """A mesh on the GPU: position, normal and material of each vertex, and where it lies on a tooth or shirt."""

    def __init__(self, context: Any, program: Any, mesh: DrawnMesh) -> None:
        self.program = program
        self._triangles, self._shown = mesh.triangles, mesh.fields["place"].copy()
        layout = mesh.layout(context, program, partly=True)
        self._buffers = {name: buffer for buffer, _, name in layout}
        self.array = context.vertex_array(program, layout, context.buffer(mesh.triangles.tobytes()))

    def reshape(self, vertices: Floats) -> None:
        """Give it other ``vertices (P, 3)``; the same as before cost nothing."""
        if np.array_equal(vertices, self._shown):
            return
        self._shown[:] = vertices
        facing = vertex_normals(vertices, self._triangles).astype(np.float32)
        for name, field in (("place", self._shown), ("facing", facing)):
            self._buffers[name].write(field.tobytes())

    def draw(self, moved: Floats) -> None:
        """Draw it moved by ``(4, 4)``."""
        self.program["moved"].write(np.asarray(moved, np.float32).T.tobytes())
        self.array.render()


class Eyeball:
    """One eye: thrust, turned about its centre, shaded by the lids as they are now."""

    def __init__(self, context: Any, program: Any, model: HeadModel, side: str) -> None:
        self.program, self.index = program, "lr".index(side)
        self.centre, self.radius = model.eye_centre(side), np.float32(model.eyes.radius)
        self.array = eyeball_mesh(model, side).array(context, program)
        self.lids = lid_margins(model, side)

    def draw(self, geometry: FaceGeometry) -> None:
        """Draw it as ``geometry`` has it."""
        turned = np.eye(4, dtype=np.float32)
        turned[:3, :3] = geometry.eye_rotations[self.index] * self.radius
        centre = self.centre + np.array([0.0, 0.0, geometry.eye_thrust[self.index]], np.float32)
        turned[:3, 3] = centre
        placed = geometry.head @ turned
        margins = [(geometry.vertices[half] - centre) / self.radius for half in self.lids]
        for name, margin in zip(("upper_lid", "lower_lid"), margins, strict=True):
            self.program[name].value = tuple(_parabola(margin[:, 0], margin[:, 1]))
        xs = np.concatenate([margin[:, 0] for margin in margins])
        self.program["corners"].value = float(xs.min()), float(xs.max())
        self.program["turned"].write(np.ascontiguousarray(placed.T, np.float32).tobytes())
        self.program["centre"].value = tuple(placed[:3, 3].tolist())
        self.program["radius"].value = float(self.radius)
        self.program["dilation"].value = float(geometry.pupils[self.index])
        self.array.render()


def rigid_mesh(vertices: Floats, triangles: Indices, material: Floats, detail: Floats) -> DrawnMesh:
    """For ``shaders/part.vert.glsl`` and ``cloth.vert.glsl``: ``vertices (P, 3)`` m at rest."""
    facing = vertex_normals(vertices, triangles)
    return DrawnMesh.of(triangles, place=vertices, rest=vertices, facing=facing, material=material, detail=detail)


def eyeball_mesh(model: HeadModel, side: str) -> DrawnMesh:
    """For ``shaders/eye.vert.glsl``: in radii from the eye's centre."""
    mesh = model.parts[f"eye_{side}"]
    places = (mesh.attributes["POSITION"] - model.eye_centre(side)) / np.float32(model.eyes.radius)
    return DrawnMesh.of(mesh.triangles, place=places, facing=vertex_normals(places, mesh.triangles))


def lid_margins(model: HeadModel, side: str) -> list[Indices]:
    """The skin's vertices along the edges of the upper and the lower lid, which shade the eye."""
    ring = model.eyelids.rings[side][LidRing.WET_LINE]
    return [np.array(half, np.int32) for half in (ring.upper, ring.lower)]


def _parabola(x: Floats, y: Floats) -> list[float]:
    rows = np.stack([np.ones_like(x), x, x * x], axis=1).astype(np.float64)
    return [float(value) for value in np.linalg.solve(rows.T @ rows + 1e-6 * np.eye(3), rows.T @ y)]
