"""Long hair as sheets: smooth surfaces that run from the parting over the head; strands and locks are by pixel."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.view.gl.drawn_mesh import DrawnMesh
from agentface.view.hair.drape import draped
from agentface.view.hair.hull import Hull
from agentface.view.hair.locks import LOCKS, Locks
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.styles import thickness_of

_EVERY, _ROWS = 3, 21
"""Which of the columns they have; points along each."""
_LAYER, _SHARE = 0.75, 0.985
"""Where between the skin and the outside of the hair the sheets lie; how long they are beside the cards."""
_LIGHT_AT_ROOT, _LIGHT, _LIGHT_AT_FACE = 0.58, 0.42, 0.62
"""How much light the cards let through to them, least where most of them lie above."""
_AT_PARTING, _AT_CROWN, _TO_CROWN, _RISE = 0.25, 0.92, (0.0, 0.24), 0.040
"""How high hair lies where it starts at the face and at the crown, as a part of its thickness; the places between which
it comes to that; the metres over which it rises from there."""
_EDGE_SHADES = ((0.60, 0.009), (0.42, 0.0150))
"""How much light the front edge keeps off the skin below it, and within how many metres: close by, and as a whole."""
_EDGE_POINTS, _EDGE_COLUMNS = 80, 9
"""Of the edge, and how many columns of a sheet behind it keep light off the skin below them."""
_ROUND_REACH = 0.025
"""Metres from where hair starts over which it comes to face its own way, not that of the head's round."""
_AT_SIDES, _SIDES = 0.56, 0.075
"""How thick hair lies beside the head as a part of that on top, and metres over the centre of the head to there."""
_ROOTWARD = 0.32
"""How much denser than half way the points along hair are at its root, where it lies round the head."""
SIGNS = 1.0, -1.0
"""Of x, of the sides of the head."""
FIRST_CARD, PAINTED = LOCKS + 1, 26
"""The number of the first card, after the locks of a sheet; up to which ``shaders/sheet_flat.vert.glsl`` paints."""
_WIDTHS = 0.3, 1.7
"""Of the spaces between columns, in locks, as parts of their mean."""
_UNEVEN = 0.03
"""The part by which the lengths of locks differ."""
_LOWEST = 0.0020
"""Metres over the hull, which is smoother than the head."""
WAVE, WAVE_OUT = 0.0150, 0.0074
"""Metres to and fro, aside and outward, of the curliest hair."""
_TUCKED = 0.5
"""How high the front edge lies, as a part of the hair's thickness."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A grid of columns of hair round the head's ``centre (3,)`` m: ``points (C, R, 3)`` m and ``places (C, R, 4)``.

    A place is across in locks, along 0..1, light that the hair above lets through, and a number of its own. ``round``
    is how far its sides face aside, where it is as round as a lock.
    """

    points: Floats
    places: Floats
    centre: Doubles
    round: float = 0.0

    def mesh(self) -> tuple[Floats, Indices]:
        """Rows of position, tangent along the hair, normal and place ``(C R, 13)``, and triangles."""
        along = unit_rows(np.gradient(self.points.astype(np.float64), axis=1))
        across = np.gradient(self.points.astype(np.float64), axis=0)
        normal = unit_rows(np.cross(across, along))
        away = unit_rows(self.points - self.centre)
        normal *= np.sign((normal * away).sum(2, keepdims=True))
        side = np.linspace(-self.round, self.round, len(self.points))[:, None, None]
        normal = unit_rows(normal + side * unit_rows(across))
        # where it parts both sides face alike, however they rise
        way = np.linalg.norm(np.diff(self.points, axis=1, prepend=self.points[:, :1]), axis=2).cumsum(axis=1)
        at_root = np.exp(-way / _ROUND_REACH)[..., None]
        normal = unit_rows((1.0 - at_root) * normal + at_root * away)
        rows = np.concatenate([self.points, along, normal, self.places], axis=2)
        columns, count = self.points.shape[:2]
        i, j = np.meshgrid(np.arange(columns - 1), np.arange(count - 1), indexing="ij")
        a = (i * count + j).ravel()
        quads = np.stack([a, a + 1, a + count, a + count, a + 1, a + count + 1], axis=1)
        rows, triangles = rows.reshape(columns * count, -1).astype(np.float32), quads.reshape(-1, 3).astype(np.int32)
        outward = rows[triangles, 6:9].sum(axis=1)
        a, b, c = (rows[triangles[:, corner], :3] for corner in range(3))
        inside = (np.cross(b - a, c - a) * outward).sum(1) < 0.0
        triangles[inside] = triangles[inside][:, ::-1]
        return rows, triangles


def sheets(model: HeadModel, look: HairLook, hull: Hull, rng: np.random.Generator) -> list[Sheet]:
    """The sheets of hair that falls from a parting over the ``hull`` with its ears: what is seen between cards."""
    thickness = thickness_of(model, look)
    return [_sheet(hull, look, draped(model, look, hull, sign)[::_EVERY], Locks.of_side(sign), thickness, rng)
            for sign in SIGNS]  # fmt: skip


def edge_shade(grown: list[Sheet], skin: Floats) -> Doubles:
    """``(V,)`` 0..1: how much of the surroundings' light hair at the face keeps off the ``skin (V, 3)`` beside it."""
    away = np.full(len(skin), np.inf, np.float32)
    for sheet in grown:
        edge = resampled(
            sheet.points[:_EDGE_COLUMNS].astype(np.float64),
            np.tile(np.linspace(0.0, 1.0, _EDGE_POINTS), (_EDGE_COLUMNS, 1)),
        )[0]
        for point in edge.reshape(-1, 3).astype(np.float32):
            away = np.minimum(away, np.linalg.norm(skin - point, axis=1))
    return np.asarray(sum(share * np.exp(-((away / reach) ** 2)) for share, reach in _EDGE_SHADES), np.float64)


def _sheet(
    hull: Hull, look: HairLook, paths: Doubles, locks: Locks, thickness: float, rng: np.random.Generator
) -> Sheet:
    widths = rng.uniform(*_WIDTHS, len(paths) - 1)
    across = np.concatenate([[0.0], np.cumsum(widths)]) * LOCKS / widths.sum()
    t = parts_along(_ROWS)
    uneven = np.interp(across, np.arange(LOCKS + 1), rng.uniform(0.0, 1.0, LOCKS + 1))
    points, along = resampled(paths, _SHARE * (1.0 - _UNEVEN * uneven)[:, None] * t)
    tucked = _TUCKED + (1.0 - _TUCKED) * smoothstep(0.0, 1.5, across)[:, None]
    near_root = 1.0 - smoothstep(0.03, 0.12, along)
    place = np.linspace(0.0, 1.0, len(paths))
    height = thickness * _LAYER * tucked * risen(place, along) * volume(hull, points)
    aside, outward = locks.waves(place, along)
    height = height + look.curl * WAVE_OUT * outward
    points = (
        points
        + height[..., None] * hull.outward(points)
        + (look.curl * WAVE * aside)[..., None] * hull.sideways(points)
    )
    points = hull.push_out(points, 0.001 + _LOWEST * smoothstep(0.0, 0.03, along))
    light = _LIGHT + (_LIGHT_AT_ROOT - _LIGHT) * near_root
    light = light + (_LIGHT_AT_FACE - _LIGHT) * (1.0 - near_root) * (1.0 - smoothstep(0.0, 1.5, across))[:, None]
    places = np.stack(np.broadcast_arrays(across[:, None], t, light, uneven[:, None]), axis=2)
    return Sheet(points.astype(np.float32), places.astype(np.float32), hull.centre)


def parts_along(rows: int) -> Doubles:
    """``(rows,)``: points along hair, 0..1, more of them on the head than where it hangs."""
    even = np.linspace(0.0, 1.0, rows)
    return np.asarray(even * (1.0 - _ROOTWARD * (1.0 - even)))


def risen(place: Doubles, along: Doubles) -> Doubles:
    """How high hair lies ``along (N, R)`` m from where it starts, as a part of its thickness.

    ``place (N,)`` 0 at the face to 1 at the nape: where the parting reaches the crown its sides lie as high as the
    rest, so that the outline of the head has no notch.
    """
    start = (_AT_PARTING + (_AT_CROWN - _AT_PARTING) * smoothstep(*_TO_CROWN, place))[:, None]
    return np.asarray(start + (1.0 - start) * np.sin(0.5 * np.pi * np.clip(along / _RISE, 0.0, 1.0)))


def volume(hull: Hull, points: Doubles) -> Doubles:
    """How thick hair lies at ``points (..., 3)`` m, as a part of its thickness: less beside the head than on it."""
    return np.asarray(_AT_SIDES + (1.0 - _AT_SIDES) * smoothstep(0.0, _SIDES, points[..., 1] - hull.centre[1]))


def resampled(paths: Doubles, parts: Doubles) -> tuple[Doubles, Doubles]:
    """``(C, R, 3)`` m and ``(C, R)`` m: points at ``parts (C, R)`` of each path's length; the lengths."""
    steps = np.linalg.norm(np.diff(paths, axis=1), axis=2)
    way = np.concatenate([np.zeros((len(paths), 1)), np.cumsum(steps, axis=1)], axis=1)
    along = way[:, -1:] * parts
    points = np.empty((*along.shape, 3))
    for column, (line, known, wanted) in enumerate(zip(paths, way, along, strict=True)):
        points[column] = np.stack([np.interp(wanted, known, line[:, axis]) for axis in range(3)], axis=1)
    return points, along


def sheets_mesh(grown: list[Sheet]) -> DrawnMesh:
    """All sheets for ``shaders/sheet.vert.glsl``."""
    meshes = [sheet.mesh() for sheet in grown]
    firsts = np.cumsum([0, *(len(rows) for rows, _ in meshes)])
    place, along_rest, facing, sheet = np.split(np.concatenate([rows for rows, _ in meshes]), (3, 6, 9), axis=1)
    triangles = [triangles + first for (_, triangles), first in zip(meshes, firsts, strict=False)]
    return DrawnMesh.of(np.concatenate(triangles), place=place, along_rest=along_rest, facing=facing, sheet=sheet)


def sheet_places(places: Floats) -> Floats:
    """``(N, 2)`` texture coordinates of ``places (N, 4)`` in what ``shaders/sheet_flat.vert.glsl`` paints."""
    number, along = places[:, 0], places[:, 1]
    card = FIRST_CARD + (number - FIRST_CARD) % (PAINTED - FIRST_CARD)
    return np.stack([np.where(number < FIRST_CARD, number, card) / PAINTED, along], axis=1).astype(np.float32)
