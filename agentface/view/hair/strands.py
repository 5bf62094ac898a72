"""Strands of hair: curves of many points that ride on the skin where they are rooted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.head.model import HeadModel
from agentface.view.gl.drawn_mesh import DrawnMesh
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.visible import Chosen, on_near_side, unhidden

_TURN_DEG, _PITCH_DEG = 12, 15
_NEAR = 0.45
"""Metres from the middle of the head."""
_REACH = 0.8
"""The part of its half width that a strand surely reaches to both sides."""
LIFT = 0.020, 0.6
"""Metres that locks are drawn nearer over their cover, so that which of two lies outside stays the same on their way;
the cover from which on."""


@dataclass(frozen=True, slots=True)
class Strands:
    """Curves at rest: first locks that hide what is behind them, then ``fine`` ones that blend.

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

    @property
    def solid(self) -> int:
        """How many of the triangles of :meth:`drawn`, the first ones, hide what is behind them."""
        return 2 * (len(self) - self.fine) * (self.points.shape[1] - 1)

    def drawn(self, skin: Floats) -> DrawnMesh:
        """All of them for ``shaders/strand.vert.glsl``, on the ``skin (V, 3)`` m at rest: two vertices a point."""
        count, points = self.points.shape[:2]
        along = np.gradient(self.points, axis=1)
        along /= np.maximum(np.linalg.norm(along, axis=2, keepdims=True), 1e-9)
        t = np.broadcast_to(np.linspace(0, 1, points, dtype=np.float32), (count, points))
        stroke = np.stack([t, np.repeat(self.radii[:, None], points, axis=1), self.cover], axis=2)

        def twice(rows: Floats) -> Floats:
            return np.repeat(rows.reshape(count * points, -1), 2, axis=0)

        return DrawnMesh.of(
            _ribbons(np.arange(count * (points - 1)), points - 1),
            anchor=np.repeat(self.anchors, 2 * points),
            offset=twice(self.points - skin[self.anchors][:, None]),
            along_rest=twice(along),
            stroke=twice(stroke),
            paint=twice(np.repeat(self.paint[:, None], points, axis=1)),
            side=np.tile(np.array([-1.0, 1.0], np.float32), count * points),
        )


class StrandArray:
    """Strands on the GPU: static, lit at their points, drawn as ribbons that face the camera."""

    def __init__(self, context: Any, program: Any, strands: Strands, model: HeadModel, centre: Doubles) -> None:
        self._context, self.program, self._strands, self._centre = context, program, strands, centre
        program["lift"].value = LIFT
        self._layout = strands.drawn(model.vertices).layout(context, program)
        self._skin = skin_round(model, centre)
        self._arrays: dict[tuple[int, int, int] | None, tuple[Any, int]] = {}
        self._drawn: tuple[Any, int] | None = None

    def draw_solid(self, eye: Doubles) -> None:
        """Draw those that hide what is behind them, as seen by ``eye`` in the model's axes, where the skin is."""
        array, solid = self._drawn = self._seen_from(sector_of(eye - self._centre))
        self.program["solid"].value = 1.0
        if solid:
            array.render(vertices=solid)

    def draw_fine(self) -> None:
        """Draw those that blend, as seen by the eye of the last ``draw_solid``."""
        array, solid = self._drawn if self._drawn is not None else self._seen_from(None)
        self.program["solid"].value = 0.0
        if array.vertices > solid:
            array.render(vertices=array.vertices - solid, first=solid)

    def _seen_from(self, sector: tuple[int, int, int] | None) -> tuple[Any, int]:
        """An array of what is seen from a sector, and how many of its indices are solid."""
        if sector not in self._arrays:
            strands, pieces = self._strands, self._strands.points.shape[1] - 1
            chosen = np.arange(len(strands) * pieces)
            if sector is not None:
                chosen = self._chosen(middle_of(sector))
            edge = (len(strands) - strands.fine) * pieces
            solid, fine = chosen[chosen < edge], np.sort(chosen[chosen >= edge])
            indices = _ribbons(np.concatenate([solid, fine]), pieces).ravel()
            array = self._context.vertex_array(self.program, self._layout, self._context.buffer(indices.tobytes()))
            self._arrays[sector] = array, 6 * len(solid)
        return self._arrays[sector]

    def _chosen(self, eye: Doubles) -> Chosen:
        """The pieces that ``eye``, from the head's middle, sees: the nearest first."""
        strands, pieces, towards = self._strands, self._strands.points.shape[1] - 1, eye / np.linalg.norm(eye)
        points = strands.points - self._centre.astype(np.float32)
        near = on_near_side(points, towards)
        points = points[near]
        across = np.cross(np.gradient(points, axis=1), unit_rows(points.reshape(-1, 3)).reshape(points.shape) + towards)
        across *= _REACH * strands.radii[near, None, None] / np.maximum(np.linalg.norm(across, axis=2), 1e-9)[..., None]
        lift = LIFT[0] * np.maximum(strands.cover[near] - LIFT[1], 0)
        seen = unhidden(points, across.astype(np.float32), lift, self._skin, eye)
        return np.asarray(near[seen // pieces] * pieces + seen % pieces)


def skin_round(model: HeadModel, centre: Doubles) -> Floats:
    """``(M, 3)`` m: points all over the skin, from ``centre``: what hides hair."""
    corners = model.vertices[model.triangles]
    return (np.concatenate([model.vertices, corners.mean(1), 0.5 * (corners[:, 0] + corners[:, 1])]) - centre).astype(
        np.float32
    )


def sector_of(arm: Doubles) -> tuple[int, int, int] | None:
    """The turn, pitch and distance about which an eye stands; None for one so near that it sees all round."""
    distance = float(np.linalg.norm(arm))
    if distance < _NEAR:
        return None
    turn = round(float(np.degrees(np.arctan2(arm[0], arm[2]))) / _TURN_DEG)
    pitch = round(float(np.degrees(np.arcsin(arm[1] / distance))) / _PITCH_DEG)
    return turn % (360 // _TURN_DEG), pitch, round(2 * np.log2(distance))


def middle_of(sector: tuple[int, int, int]) -> Doubles:
    """The place from the head's middle that stands for a sector, metres."""
    turn, pitch = np.radians([sector[0] * _TURN_DEG, sector[1] * _PITCH_DEG])
    towards = np.array([np.sin(turn) * np.cos(pitch), np.sin(pitch), np.cos(turn) * np.cos(pitch)])
    return np.asarray(2.0 ** (0.5 * sector[2]) * towards)


def _ribbons(chosen: Chosen, pieces: int) -> Indices:
    """Two triangles for each of the pieces ``strand * pieces + piece``."""
    first = 2 * (chosen // pieces * (pieces + 1) + chosen % pieces)
    return np.asarray((first[:, None] + np.array([0, 1, 2, 1, 3, 2])).reshape(-1, 3).astype(np.int32))


def nearest_vertices(points: Doubles, vertices: Floats) -> Indices:
    """``(N,)``: the vertex nearest to each point ``(N, 3)``."""
    nearest = np.empty(len(points), np.int32)
    square, across = (vertices**2).sum(1), np.ascontiguousarray(-2.0 * vertices.T)
    for start in range(0, len(points), 512):
        part = points[start : start + 512].astype(np.float32)
        nearest[start : start + 512] = (square + part @ across).argmin(1)
    return nearest
