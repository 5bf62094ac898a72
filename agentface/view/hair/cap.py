"""The layer on the scalp below the strands: what one sees between them, and where they begin."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.normals import vertex_normals
from agentface.mesh.refine import refine
from agentface.view.hair.hairline import Hairline
from agentface.view.hair.ribbons import unit_rows
from agentface.view.parts.anchored import Anchored, AnchoredArray

_THICKNESS = {"cropped": 0.0028, "swept": 0.0010, "bob": 0.0010, "bun": 0.0010}
_OPAQUE = 0.97
_STRIP = {"cropped": 0.017, "swept": 0.013, "bob": 0.008, "bun": 0.013}
"""Metres in which it fades in behind the hairline."""


class Cap:
    """The layer on the GPU: what is far enough behind the hairline hides the skin, the strip at it blends."""

    def __init__(self, context: Any, program: Any, mesh: Anchored, skin: Floats) -> None:
        ordered, solid = solid_first(mesh)
        self._array, self._solid = AnchoredArray(context, program, ordered, skin).array, 3 * solid

    def draw_solid(self) -> None:
        """Draw what hides the skin."""
        self._array.render(vertices=self._solid)

    def draw_soft(self) -> None:
        """Draw the strip at the hairline, which blends."""
        self._array.render(vertices=self._array.vertices - self._solid, first=self._solid)


def solid_first(mesh: Anchored) -> tuple[Anchored, int]:
    """The same cap with the triangles that hide the skin before those that blend, and how many do."""
    clear = (mesh.material[mesh.triangles, 0] < _OPAQUE).any(1)
    triangles = np.concatenate([mesh.triangles[~clear], mesh.triangles[clear]])
    return replace(mesh, triangles=triangles), int((~clear).sum())


def scalp_cap(model: HeadModel, line: Hairline, look: HairLook) -> Anchored:
    """What one sees between the strands: the scalp refined and lifted, ending softly at the hairline.

    Material: depth behind the hairline 0..1, ambient light, two spare.
    """
    over = line.over(model)
    chosen = over[model.triangles].max(1) > -0.012
    used, local = np.unique(model.triangles[chosen], return_inverse=True)
    triangles: Indices = local.reshape(-1, 3).astype(np.int32)
    places, normals = model.vertices[used], model.normals[used]
    light = model.shade[used, :1]
    mesh = refine(triangles, len(places))
    places = mesh.positions(places, normals)
    normals = unit_rows(mesh.mean(normals)).astype(np.float32)
    light, triangles = mesh.mean(light), mesh.triangles
    anchors = np.repeat(used[mesh.ends].astype(np.int32), 2, axis=1)
    depth = line.behind(places)
    strip = line.taper(places, _STRIP[look.style]) if look.style == "cropped" else _STRIP[look.style]
    # what is nearly clear lies on the skin: beyond its outline one would see through
    rise = 0.0003 + _THICKNESS[look.style] * np.clip((depth - 0.6 * strip) / 0.020, 0, 1)
    lifted = places + normals * rise[:, None].astype(np.float32)
    ones = np.ones(len(places))
    edge = np.clip((depth + 0.001) / strip, 0, 1)
    triangles = triangles[edge[triangles].max(1) > 0]
    material = np.column_stack([edge, np.clip(1.3 * light[:, 0], 0, 1), ones, ones])
    normals = vertex_normals(lifted, triangles).astype(np.float32)
    return Anchored(lifted, normals, triangles, anchors, material.astype(np.float32))
