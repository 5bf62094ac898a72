"""Strands of hair: curves of many points that ride on the skin where they are rooted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats, Indices


@dataclass(frozen=True, slots=True)
class Strands:
    """Curves at rest: first those that hide what is behind them, the outermost first, then ``fine`` ones that blend.

    Attributes:
        points: ``(N, P, 3)`` float32 m.
        anchors: ``(N,)`` int32, the skin vertex that each strand moves with.
        radii: ``(N,)`` float32, half widths in metres.
        paint: ``(N, 4)`` float32, linear colour and opacity.
        cover: ``(N, P)`` float32 0..1, how much light the hair above lets through.
    """

    points: Floats
    anchors: Indices
    radii: Floats
    paint: Floats
    cover: Floats
    fine: int

    def __len__(self) -> int:
        return len(self.radii)


class StrandArray:
    """Strands on the GPU: static, lit at their points, drawn as ribbons that face the camera."""

    def __init__(self, context: Any, program: Any, strands: Strands, skin: Floats) -> None:
        self.program = program
        count, points = strands.points.shape[:2]
        offsets = strands.points - skin[strands.anchors][:, None]
        along = np.gradient(strands.points, axis=1)
        along /= np.maximum(np.linalg.norm(along, axis=2, keepdims=True), 1e-9)
        t = np.broadcast_to(np.linspace(0, 1, points, dtype=np.float32), (count, points))
        radii = np.repeat(strands.radii[:, None], points, axis=1)
        paint = np.repeat(strands.paint[:, None], points, axis=1)
        rows = np.concatenate([offsets, along, np.stack([t, radii, strands.cover], axis=2), paint], axis=2)
        floats = np.repeat(rows.reshape(count * points, -1), 2, axis=0).astype(np.float32)
        sides = np.tile(np.array([-1.0, 1.0], np.float32), count * points)[:, None]
        anchors = np.repeat(strands.anchors, 2 * points).astype(np.int32)
        layout = [
            (context.buffer(anchors.tobytes()), "1i", "anchor"),
            (context.buffer(np.concatenate([floats, sides], axis=1).tobytes()), "3f 3f 3f 4f 1f",
             "offset", "along_rest", "stroke", "paint", "side"),
        ]  # fmt: skip
        quads = (np.arange(count)[:, None] * 2 * points + 2 * np.arange(points - 1)).reshape(-1, 1)
        triangles = (quads + np.array([0, 1, 2, 1, 3, 2])).reshape(-1, 3).astype(np.int32)
        self.array = context.vertex_array(program, layout, context.buffer(triangles.tobytes()))
        self.solid = 6 * (points - 1) * (count - strands.fine)

    def draw_solid(self, outermost: float) -> None:
        """Draw those that hide what is behind them, where the skin is: the part ``outermost`` 0..1 of them."""
        self.program["solid"].value = 1.0
        self.array.render(vertices=round(outermost * self.solid / 6) * 6)

    def draw_fine(self) -> None:
        """Draw those that blend."""
        self.program["solid"].value = 0.0
        self.array.render(vertices=self.array.vertices - self.solid, first=self.solid)


def nearest_vertices(points: Doubles, vertices: Floats) -> Indices:
    """``(N,)``: the vertex nearest to each point ``(N, 3)``."""
    nearest = np.empty(len(points), np.int32)
    square, across = (vertices**2).sum(1), np.ascontiguousarray(-2.0 * vertices.T)
    for start in range(0, len(points), 512):
        part = points[start : start + 512].astype(np.float32)
        nearest[start : start + 512] = (square + part @ across).argmin(1)
    return nearest
