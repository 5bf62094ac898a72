"""Long hair as sheets: smooth surfaces that run from the parting over the head; strands and locks are by pixel."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import SIDES, Doubles, Floats, Indices
from agentface.head.look import HairLook
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep
from agentface.view.gl.drawn_mesh import DrawnMesh
from agentface.view.hair.drape import draped
from agentface.view.hair.groom import waves
from agentface.view.hair.hull import Hull
from agentface.view.hair.ribbons import unit_rows
from agentface.view.hair.strands import middle_of, sector_of, skin_round
from agentface.view.hair.styles import REFERENCE_EYES, STYLES
from agentface.view.hair.visible import before_skin

_EVERY, _ROWS = 3, 18
"""Which of the columns they have; points along each."""
_LAYER_AT_ROOT, _LAYER, _SHARE = 0.66, 0.42, 0.97
"""Where between the skin and the outside of the hair the sheets lie, and how long they are beside the cards."""
_LIGHT_AT_ROOT, _LIGHT = 0.68, 0.42
"""How much light the cards let through to them."""
_AT_PARTING, _RISE = 0.22, 0.050
"""How high hair lies where it starts, as a part of its thickness, and the metres over which it rises from there."""
_EDGE_SHADE, _EDGE_REACH = 0.6, 0.011
"""How much light the front edge keeps off the skin below it, and within how many metres."""
ROOTWARD = 1.25
"""The exponent with which the points along hair gather at its root."""
LOCKS, FIRST_CARD, PAINTED = 13, 14, 26
"""Of a sheet; the number of the first card; up to which number ``shaders/sheet_flat.vert.glsl`` paints."""
_WIDTHS = 0.3, 1.7
"""Of the spaces between columns, in locks, as parts of their mean."""
_UNEVEN = 0.05
"""The part by which the lengths of locks differ."""
_LOWEST = 0.0045
"""Metres over the hull, which is smoother than the head."""
_INSIDE_BELOW = 0.045
"""Metres over the centre: below it hair stands off forehead, face and neck, and is seen from inside too."""
_BARE_INSIDE = 20.0
"""Up to which number locks are seen from inside: the sheets' and those of the cards at the face."""
_TUCKED = 0.2
"""How high the front edge lies, as a part of the hair's thickness."""
_COVERAGE = 0x809E, 0x809F
"""GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_ALPHA_TO_ONE."""


@dataclass(frozen=True, slots=True)
class Sheet:
    """A grid of columns of hair round the head's ``centre (3,)`` m: ``points (C, R, 3)`` m and ``places (C, R, 4)``.

    A place is across in locks, along 0..1, light that the hair above lets through, and a number of its own.
    """

    points: Floats
    places: Floats
    centre: Doubles

    def mesh(self) -> tuple[Floats, Indices]:
        """Rows of position, tangent along the hair, normal and place ``(C R, 13)``, and triangles."""
        along = unit_rows(np.gradient(self.points.astype(np.float64), axis=1))
        across = np.gradient(self.points.astype(np.float64), axis=0)
        normal = unit_rows(np.cross(across, along))
        normal *= np.sign((normal * (self.points - self.centre)).sum(2, keepdims=True))
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
    style = STYLES[look.style]
    thickness = style.thickness * look.volume * model.landmarks.eye_separation / REFERENCE_EYES
    return [
        _sheet(hull, look, draped(model, look, hull, 1.0 if side == SIDES[0] else -1.0)[::_EVERY], thickness, rng)
        for side in SIDES
    ]


def edge_shade(grown: list[Sheet], skin: Floats) -> Doubles:
    """``(V,)`` 0..1: how much of the surroundings' light hair at the face keeps off the ``skin (V, 3)`` beside it."""
    away = np.full(len(skin), np.inf, np.float32)
    for sheet in grown:
        away = np.minimum(away, np.linalg.norm(skin[:, None] - sheet.points[0], axis=2).min(axis=1))
    return np.asarray(_EDGE_SHADE * np.exp(-((away / _EDGE_REACH) ** 2)), np.float64)


def _sheet(hull: Hull, look: HairLook, paths: Doubles, thickness: float, rng: np.random.Generator) -> Sheet:
    widths = rng.uniform(*_WIDTHS, len(paths) - 1)
    across = np.concatenate([[0.0], np.cumsum(widths)]) * LOCKS / widths.sum()
    t = np.linspace(0.0, 1.0, _ROWS) ** ROOTWARD
    uneven = np.interp(across, np.arange(LOCKS + 1), rng.uniform(0.0, 1.0, LOCKS + 1))
    points, along = resampled(paths, _SHARE * (1.0 - _UNEVEN * uneven)[:, None] * t)
    tucked = _TUCKED + (1.0 - _TUCKED) * smoothstep(0.0, 1.5, across)[:, None]
    risen = _AT_PARTING + (1.0 - _AT_PARTING) * np.sin(0.5 * np.pi * np.clip(along / _RISE, 0.0, 1.0))
    near_root = 1.0 - smoothstep(0.03, 0.12, along)
    layer = _LAYER + (_LAYER_AT_ROOT - _LAYER) * near_root
    points = points + (thickness * layer * tucked * risen)[..., None] * hull.outward(points)
    points = hull.push_out(points, 0.001 + _LOWEST * smoothstep(0.0, 0.03, along))
    if look.curl:
        points = points + 0.003 * look.curl * waves(hull, points, along, uneven)
    light = _LIGHT + (_LIGHT_AT_ROOT - _LIGHT) * near_root
    places = np.stack(np.broadcast_arrays(across[:, None], t, light, uneven[:, None]), axis=2)
    return Sheet(points.astype(np.float32), places.astype(np.float32), hull.centre)


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


def hanging_first(mesh: DrawnMesh, triangles: Indices, centre: Doubles) -> tuple[Indices, int]:
    """``triangles (T, 3)``, those first that are seen from inside too, and how many are: what hangs beside face and neck.

    ``centre (3,)`` m is the head's. Cards behind those at the face have a sheet inside of them.
    """
    low = mesh.fields["place"][triangles, 1].min(axis=1) < centre[1] + _INSIDE_BELOW
    seen = low & (mesh.fields["sheet"][triangles[:, 0], 0] < _BARE_INSIDE)
    return triangles[np.argsort(~seen, kind="stable")], int(seen.sum())


def sheet_places(places: Floats) -> Floats:
    """``(N, 2)`` texture coordinates of ``places (N, 4)`` in the picture that ``shaders/sheet_flat.vert.glsl`` paints."""
    number, along = places[:, 0], places[:, 1]
    card = FIRST_CARD + (number - FIRST_CARD) % (PAINTED - FIRST_CARD)
    return np.stack([np.where(number < FIRST_CARD, number, card) / PAINTED, along], axis=1).astype(np.float32)


class SheetArray:
    """Sheets on the GPU; they turn with the head."""

    def __init__(self, context: Any, program: Any, grown: list[Sheet], model: HeadModel, centre: Doubles) -> None:
        """``centre`` m: hair well above it has the head behind it and is seen from outside only."""
        self._context, self._program, self._centre = context, program, centre
        self._mesh = sheets_mesh(grown)
        self._layout = self._mesh.layout(context, program)
        self._skin = skin_round(model, centre)
        self._arrays: dict[tuple[int, int, int] | None, tuple[Any, int]] = {}
        self._drawn: tuple[Any, int] = self._seen_from(None)
        self._flags: tuple[int, ...] = ()

    def draw(self, eye: Doubles, *, fine: bool) -> None:
        """Draw what ``eye``, in the model's axes, sees from outside; ``fine``: into several samples a pixel."""
        self._program["least_cover"].value = 0.02 if fine else 0.5
        self._flags = _COVERAGE if fine else ()
        self._drawn = self._seen_from(sector_of(eye - self._centre))
        self._draw("back", self._drawn[0].vertices)

    def draw_inside(self) -> None:
        """Draw what the eye of the last ``draw`` sees from inside, after the skin: hair beside face and neck."""
        self._draw("front", self._drawn[1])

    def _draw(self, culled: str, count: int) -> None:
        context, (array, _) = self._context, self._drawn
        context.cull_face = culled
        context.enable(context.CULL_FACE)
        for flag in self._flags:
            context.enable_direct(flag)
        array.render(vertices=count)
        for flag in self._flags:
            context.disable_direct(flag)
        context.disable(context.CULL_FACE)
        context.cull_face = "back"

    def _seen_from(self, sector: tuple[int, int, int] | None) -> tuple[Any, int]:
        """An array of what may be seen from a sector, and how many of its indices hang: these are seen from inside."""
        if sector not in self._arrays:
            places = self._mesh.fields["place"] - self._centre.astype(np.float32)
            triangles = self._mesh.triangles
            if sector is not None:
                triangles = triangles[before_skin(places, self._skin, middle_of(sector))[triangles].any(axis=1)]
            ordered, hanging = hanging_first(self._mesh, triangles, self._centre)
            buffer = self._context.buffer(ordered.tobytes())
            self._arrays[sector] = self._context.vertex_array(self._program, self._layout, buffer), 3 * hanging
        return self._arrays[sector]
