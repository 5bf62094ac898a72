"""Hairs that grow on the skin: each a tapered curve from a root in a triangle, so that it follows every expression."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.view.gl.drawn_mesh import DrawnMesh

_AROUND = 0.004  # m, how far round the places triangles are looked at
_POINTS = 4


@dataclass(frozen=True, slots=True)
class Roots:
    """``corners (N, 3)``: the vertices of each root's triangle; ``weights (N, 3)``: where it lies in it."""

    corners: Indices
    weights: Floats

    def frames(self, vertices: Floats, normals: Floats) -> tuple[Doubles, Doubles]:
        """The roots ``(N, 3)`` and their axes ``(N, 3, 3)`` in columns: along an edge, across it, normal.

        The axes turn and move with the skin. ``shaders/ribbon.vert.glsl`` does the same.
        """
        weights = self.weights[..., None].astype(np.float64)
        roots = (vertices[self.corners] * weights).sum(1)
        n = unit_rows((normals[self.corners] * weights).sum(1))
        edge = (vertices[self.corners[:, 1]] - vertices[self.corners[:, 0]]).astype(np.float64)
        x = unit_rows(edge - n * (edge * n).sum(1, keepdims=True))
        return roots, np.stack([x, np.cross(n, x), n], axis=2)


@dataclass(frozen=True, slots=True)
class Hairs:
    """Quadratic Bezier curves in their roots' axes.

    ``bends`` and ``tips`` ``(N, 3)`` are control points from the root in metres, ``radii (N,)`` half widths in
    metres, ``paint (N, 4)`` linear colour and opacity.
    """

    roots: Roots
    bends: Floats
    tips: Floats
    radii: Floats
    paint: Floats

    @classmethod
    def grown(
        cls, roots: Roots, at_rest: tuple[Floats, Floats], bends: Doubles, tips: Doubles, radii: Doubles, paint: Doubles
    ) -> Hairs:
        """Hairs whose control points are given in the model's axes at rest (``(vertices, normals)``)."""
        axes = roots.frames(*at_rest)[1]
        local = [np.einsum("nij,ni->nj", axes, points).astype(np.float32) for points in (bends, tips)]
        return cls(roots, local[0], local[1], radii.astype(np.float32), paint.astype(np.float32))

    def curve(self, vertices: Floats, normals: Floats, t: float) -> Doubles:
        """``(N, 3)``: the point at ``t`` 0..1 of each hair on the skin as it is now."""
        roots, axes = self.roots.frames(vertices, normals)
        offsets = 2 * t * (1 - t) * self.bends + t * t * self.tips
        return np.asarray(roots + np.einsum("nij,nj->ni", axes, offsets))

    def drawn(self) -> DrawnMesh:
        """For ``shaders/ribbon.vert.glsl``: two vertices at each of some points along a hair."""
        steps, sides = np.repeat(np.linspace(0.0, 1.0, _POINTS), 2), np.tile([-1.0, 1.0], _POINTS)
        count, each = len(self), 2 * _POINTS
        quads = (np.arange(count)[:, None] * each + 2 * np.arange(_POINTS - 1)).reshape(-1, 1)
        return DrawnMesh.of(
            (quads + np.array([0, 1, 2, 1, 3, 2])).reshape(-1, 3),
            corners=np.repeat(self.roots.corners, each, axis=0),
            weights=np.repeat(self.roots.weights, each, axis=0),
            bend=np.repeat(self.bends, each, axis=0),
            tip=np.repeat(self.tips, each, axis=0),
            stroke=np.stack([np.tile(steps, count), np.tile(sides, count), np.repeat(self.radii, each)], axis=1),
            paint=np.repeat(self.paint, each, axis=0),
        )

    def __len__(self) -> int:
        return len(self.radii)


class HairArray:
    """Hairs on the GPU: static, the vertex shader puts them on the skin of the frame."""

    def __init__(self, context: Any, program: Any, hairs: Hairs, gloss: float) -> None:
        self.program, self.gloss, self.count = program, gloss, len(hairs)
        self.array = hairs.drawn().array(context, program)

    def draw(self, share: float = 1.0) -> None:
        """Draw them, or the first ``share`` 0..1 of them, where the skin is."""
        self.program["gloss"].value = self.gloss
        self.array.render(vertices=6 * (_POINTS - 1) * max(1, round(share * self.count)))


def unit_rows(rows: Doubles | Floats) -> Doubles:
    """Rows of length one."""
    return np.asarray(rows / np.maximum(np.linalg.norm(rows, axis=-1, keepdims=True), 1e-12))


def roots_in_front(points: Doubles, vertices: Floats, triangles: Indices) -> Roots:
    """Roots on the front-most triangle at each place ``points (N, 2)`` (x, y); places off it take the nearest."""
    a, b, c = (vertices[triangles[:, corner]].astype(np.float64) for corner in range(3))
    u, v = (b - a)[:, :2], (c - a)[:, :2]
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    corners = vertices[triangles][..., :2]
    near = (corners.max(1) > points.min(0) - _AROUND) & (corners.min(1) < points.max(0) + _AROUND)
    towards = np.flatnonzero((area > 1e-10) & near.all(1))
    u, v, area, a = u[towards], v[towards], area[towards], a[towards]
    off = points[:, None] - a[None, :, :2]
    second = (off[..., 0] * v[:, 1] - off[..., 1] * v[:, 0]) / area
    third = (u[:, 0] * off[..., 1] - u[:, 1] * off[..., 0]) / area
    outside = -np.minimum(np.minimum(second, third), 1 - second - third)
    # inside: the front-most; else the triangle that is missed by the least
    score = np.where(outside <= 1e-9, a[None, :, 2] + 10.0, -outside)
    best = score.argmax(1)
    row = np.arange(len(points))
    weights = np.stack([1 - second[row, best] - third[row, best], second[row, best], third[row, best]], axis=1)
    weights = np.maximum(weights, 0.0)
    return Roots(triangles[towards[best]], (weights / weights.sum(1, keepdims=True)).astype(np.float32))


def roots_along(ring: Indices, vertices: Floats, places: Doubles) -> Roots:
    """Roots on a line of vertices, at parts 0..1 of its length."""
    steps = np.linalg.norm(np.diff(vertices[ring].astype(np.float64), axis=0), axis=1)
    length = np.concatenate([[0.0], np.cumsum(steps)])
    at = places * length[-1]
    first = np.clip(np.searchsorted(length, at, side="right") - 1, 0, len(ring) - 2)
    part = np.clip((at - length[first]) / steps[first], 0.0, 1.0)
    corners = np.stack([ring[first], ring[first + 1], ring[first + 1]], axis=1)
    return Roots(corners, np.stack([1 - part, part, np.zeros_like(part)], axis=1).astype(np.float32))
