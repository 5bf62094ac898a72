"""Meshes that ride on the skin without being part of it: hair as a surface, the lining of the eye sockets."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import SIDES, Floats, Indices
from agentface.head.model import HeadModel
from agentface.head.ring_names import LidRing
from agentface.view.gl.drawn_mesh import DrawnMesh

_LINING_DEPTHS = ((0.0, 1.0), (0.004, 0.98), (0.012, 0.72))


@dataclass(frozen=True, slots=True)
class Anchored:
    """``vertices (N, 3)`` at rest that move with the mean of the skin's vertices ``anchors (N, 4)``."""

    vertices: Floats
    normals: Floats
    triangles: Indices
    anchors: Indices
    material: Floats

    def drawn(self, skin: Floats) -> DrawnMesh:
        """For ``shaders/anchored.vert.glsl`` and ``cap.vert.glsl``, on the ``skin (V, 3)`` m at rest."""
        return DrawnMesh.of(
            self.triangles,
            anchors=self.anchors,
            offset=self.vertices - skin[self.anchors].mean(1),
            facing=self.normals,
            rest=self.vertices,
            material=self.material,
        )


class AnchoredArray:
    """An anchored mesh on the GPU."""

    def __init__(self, context: Any, program: Any, mesh: Anchored, skin: Floats) -> None:
        self.array = mesh.drawn(skin).array(context, program)

    def draw(self) -> None:
        """Draw it where the skin is."""
        self.array.render()


def eye_lining(model: HeadModel, side: str) -> Anchored:
    """A funnel of flesh from the inner lid margin back along the eyeball: no gap shows the inside of the head."""
    ring = model.eyelids.rings[side][LidRing.INNER_MARGIN]
    loop = np.array(ring.upper + ring.lower[-2:0:-1], np.int32)
    centre = model.eye_centre(side)
    rows = []
    for depth, width in _LINING_DEPTHS:
        row = centre + (model.vertices[loop] - centre) * np.array([width, width, 1.0], np.float32)
        row[:, 2] -= depth
        rows.append(row)
    count = len(loop)
    i = np.arange(count)
    j = (i + 1) % count
    quads = [np.stack([[i, j, i + count], [j, j + count, i + count]]) + row * count for row in range(len(rows) - 1)]
    triangles = np.concatenate([quad.transpose(0, 2, 1).reshape(-1, 3) for quad in quads]).astype(np.int32)
    total = count * len(rows)
    material = np.zeros((total, 4), np.float32)
    material[:, 1] = np.repeat(1.0 - np.linspace(0.0, 1.0, len(rows)), count)
    facing = np.tile(np.array([0, 0, 1], np.float32), (total, 1))
    anchors = np.repeat(np.tile(loop, len(rows))[:, None], 4, axis=1)
    return Anchored(np.concatenate(rows).astype(np.float32), facing, triangles, anchors, material)


def eye_linings(model: HeadModel) -> list[Anchored]:
    """The linings of both eyes."""
    return [eye_lining(model, side) for side in SIDES]
