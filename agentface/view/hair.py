"""Hair of the head: where it begins, where it is rooted, and the dark layer on the scalp below the strands."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Doubles, Floats, Indices
from agentface.view.anchored import Anchored
from agentface.view.hull import spread_over
from agentface.view.look import HairLook
from agentface.view.refine import refine, vertex_normals
from agentface.view.ribbons import unit_rows

# The hairline over the azimuth about the head's vertical axis: 0 the forehead, 180 the nape; heights over the eyes
# in distances between the pupils.
_AZIMUTH_DEG = (0, 12, 24, 32, 38, 43, 47, 51, 55, 59, 63, 67, 72, 84, 90, 97, 105, 118, 150, 180)
_HEIGHT = (
    1.0, 1.0, 0.985, 0.95, 0.86, 0.70, 0.52, 0.26, -0.06, -0.28,
    -0.36, -0.36, -0.36, -0.36, -0.40, -0.56, -0.85, -1.05, -1.18, -1.22,
)  # fmt: skip
_AXIS_Z = -0.69
_SOFT = 0.006
"""Metres over which hair grows denser behind the hairline."""
_CAP_THICKNESS = {"cropped": 0.0018, "swept": 0.0010, "bob": 0.0010, "bun": 0.0010}


class Hairline:
    """How far points lie behind the hairline of a face."""

    def __init__(self, model: HeadModel, height: float) -> None:
        self.unit = model.landmarks.eye_separation
        self.top = height * float(model.landmarks["hairline_middle"][1])
        turns = np.arange(181.0)
        table = np.interp(turns, _AZIMUTH_DEG, _HEIGHT)
        padded = np.concatenate([table[4:0:-1], table, table[-2:-6:-1]])
        self._turns, self._heights = turns, np.convolve(padded, np.hanning(11)[1:-1] / np.hanning(11).sum(), "valid")

    def behind(self, points: Floats | Doubles) -> Doubles:
        """``(N,)`` metres behind the hairline at each point ``(N, 3)`` of the head; negative on face and ears."""
        turn = np.degrees(np.arctan2(np.abs(points[:, 0]), points[:, 2] - _AXIS_Z * self.unit))
        height = np.interp(turn, self._turns, self._heights)
        # the forehead's part is fixed by the landmark, the rest by the size of the face
        above = points[:, 1] - np.where(height > 0, height * self.top, height * self.unit)
        y, z = points[:, 1] / self.unit + 0.40, points[:, 2] / self.unit + 0.24
        off_ear = (np.hypot(y / 0.54, (z + 0.25 * y) / 0.40) - 1) * 0.42 * self.unit
        return np.asarray(np.minimum(above, off_ear))

    def over(self, model: HeadModel) -> Doubles:
        """``(V,)`` metres behind the hairline for the vertices of the skin."""
        return self.behind(model.vertices)


@dataclass(frozen=True, slots=True)
class HairRoots:
    """Places on the scalp: ``places`` and ``normals`` ``(N, 3)``, ``depth (N,)`` metres behind the hairline."""

    places: Doubles
    normals: Doubles
    depth: Doubles

    @classmethod
    def drawn(
        cls, model: HeadModel, normals: Floats, line: Hairline, count: int, rng: np.random.Generator
    ) -> HairRoots:
        """``count`` roots spread over the scalp, fewer and fewer towards the hairline."""
        over = line.over(model)
        triangles = model.triangles[over[model.triangles].max(1) > -0.02]
        drawn, weights = spread_over(model.vertices, triangles, 3 * count, rng)
        corners = triangles[drawn]
        places = (model.vertices[corners] * weights[..., None]).sum(1)
        depth = line.behind(places)
        # a hairline is not a line
        depth += 0.0020 * _wave(places * 190.0) + 0.0012 * _wave(places * 520.0)
        kept = np.flatnonzero(depth > _SOFT * (rng.random(len(depth)) ** 1.5 - 0.35))[:count]
        shown = unit_rows((normals[corners[kept]] * weights[kept][..., None]).sum(1))
        return cls(places[kept], shown, depth[kept])

    def __len__(self) -> int:
        return len(self.depth)


def hidden(model: HeadModel, line: Hairline, look: HairLook) -> Doubles:
    """``(V,)`` 0..1: how much hair hides each vertex of the skin, on the scalp and behind hair that falls over it."""
    scalp = np.clip((line.over(model) + 0.003) / 0.014, 0, 1)
    if look.style != "bob":
        return np.asarray(scalp)
    y, z = model.vertices[:, 1], model.vertices[:, 2]
    bottom = look.length * float(model.landmarks["menton"][1])
    behind = np.clip((0.05 * line.unit - z) / (0.35 * line.unit), 0, 1) * np.clip((y - bottom) / 0.03, 0, 1)
    return np.maximum(scalp, 0.9 * behind * (y < 0.6 * line.unit))


def _wave(points: Doubles) -> Doubles:
    x, y, z = points.T
    return np.asarray(np.sin(x + 1.7 * np.sin(y)) * np.cos(z + 1.3 * np.sin(x)))


def scalp_cap(model: HeadModel, line: Hairline, look: HairLook) -> Anchored:
    """What one sees between the strands: the scalp refined and lifted, ending softly at the hairline.

    Material: depth behind the hairline 0..1, ambient light, two spare.
    """
    over = line.over(model)
    chosen = over[model.triangles].max(1) > -0.012
    used, local = np.unique(model.triangles[chosen], return_inverse=True)
    triangles: Indices = local.reshape(-1, 3).astype(np.int32)
    all_normals = vertex_normals(model.vertices, model.triangles)
    places, normals = model.vertices[used], all_normals[used]
    light = model.shade[used, :1]
    anchors = np.repeat(used.astype(np.int32)[:, None], 1 if look.style == "cropped" else 2, axis=1)
    # the edge of short hair is seen, that of long hair lies below strands
    for _ in range(2 if look.style == "cropped" else 1):
        mesh = refine(triangles, len(places))
        places = mesh.positions(places, normals)
        normals = unit_rows(mesh.mean(normals)).astype(np.float32)
        light, triangles = mesh.mean(light), mesh.triangles
        anchors = np.concatenate([anchors[mesh.ends[:, 0]], anchors[mesh.ends[:, 1]]], axis=1)
    depth = line.behind(places)
    rise = 0.0003 + _CAP_THICKNESS[look.style] * np.clip(depth / 0.020, 0, 1)
    lifted = places + normals * rise[:, None].astype(np.float32)
    ones = np.ones(len(places))
    material = np.column_stack([np.clip((depth + 0.001) / 0.016, 0, 1), np.clip(1.3 * light[:, 0], 0, 1), ones, ones])
    return Anchored(lifted, vertex_normals(lifted, triangles), triangles, anchors, material.astype(np.float32))
