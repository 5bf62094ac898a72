"""The lips as a B-spline surface, and orbicularis oris on its control points (Bui et al., sections 2.2 and 3.2).

The surface is bicubic: 24 columns of control points that close round the mouth, 6 rows from inside the mouth over the
red to the skin. What moves the mouth moves the control points; the vertices of the lips take the surface's movement,
so that the lips at rest keep every detail of the mesh.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.morphs import WHOLE_LIPS
from agentface.deform.mouth.lip_grid import SEAM_RING, lip_grid
from agentface.deform.mouth.lip_skirt import skirt as lip_skirt
from agentface.deform.mouth.lip_surface import COLUMNS, ROWS, control_places, fit, grid_places, moved_with, weights
from agentface.deform.mouth.orbicularis_oris import contractions
from agentface.head.model import HeadModel
from agentface.parameters import indices_of

_BLEND = (0.34, 0.67, 1.0)  # from the innermost ring of the patch
_OUTER_BLEND = (0.12, 0.5, 0.88)  # from its outermost ring
CONTRACTIONS = 3
"""Pucker, press and roll."""
RED = 2, 3
"""Rows of control points whose middle is the middle of the red."""
THINNED = tuple(np.float32(share) for share in (0.2, 0.7, 1.0, 1.0, 0.7, 0.15))
"""How much of a stretch each row pays with its distance from there: lips keep their volume."""


class LipTables(NamedTuple):
    """What the lips of one face need a frame.

    Attributes:
        skin_count: V; the control points are the rows from here on.
        control_rest: ``(144, 3)`` m.
        control_vertices, control_weights: ``(144, 4)``: skin vertices over which a control point lies, and their
            weights, which sum to 1.
        across, along: ``(N,)`` 0..24, ``(R,)`` 0..1: where columns and rings of the patch lie on the surface.
        patch: ``(P,)`` vertices that take the surface's movement, one ring of the grid after the other; P = R N.
        controls, weight: ``(P, 16)``: the control points that act on each, and how much.
        rest: ``(P, 3)`` m, the vertices at rest.
        blend: ``(P,)`` 0..1, how far they follow the surface and not the skin.
        rim: ``(K,)`` rows of ``patch`` whose blend is below 1.
        skirt, skirt_index, skirt_weight: ``(F,)``, ``(F, 4)``, ``(F, 4)``: vertices beyond the patch that follow the
            movement of its edge under orbicularis oris, the control points of the edge, and weights with the fade.
        parameters: ``(2,)``, where pucker and press stand in a pose.
        width: m, of the mouth at rest, from corner to corner in the middle of the red.
        roll_from: 0..1, the press above which the lips also roll in.
        shift: ``(3, 144, 3)`` m: rotation and extrusion of pucker, press and roll at full contraction.
        target: ``(3, 144, 2)`` m: the place (x, y) of each control point on the ellipse.
        pull: ``(3, 144)`` 0..1: how far each goes there.
    """

    skin_count: int
    control_rest: Floats
    control_vertices: Indices
    control_weights: Floats
    across: Floats
    along: Floats
    patch: Indices
    controls: Indices
    weight: Floats
    rest: Floats
    blend: Floats
    rim: Indices
    skirt: Indices
    skirt_index: Indices
    skirt_weight: Floats
    parameters: Indices
    width: float
    roll_from: float
    shift: Floats
    target: Floats
    pull: Floats


def prepare(model: HeadModel) -> LipTables:
    """The tables of a face; raises InvalidValueError where the mesh round its mouth is no grid."""
    grid, points = lip_grid(model), model.vertices.astype(np.float64)
    across, along = grid_places(grid, points)
    places = np.broadcast_to(across, grid.vertices.shape), along[:, None] + 0.0 * across
    patch = grid.vertices.ravel()
    index, weight = weights(*places)
    control = fit(index.reshape(-1, 16), weight.reshape(-1, 16), points[patch])
    index, weight = weights(moved_with(*places), places[1])
    index, weight = index.reshape(-1, 16), weight.reshape(-1, 16)
    blend = np.ones(grid.vertices.shape)
    blend[: len(_BLEND)] = np.array(_BLEND)[:, None]
    blend[-len(_OUTER_BLEND) :] = np.array(_OUTER_BLEND)[::-1, None]
    line_index, line_weight = weights(np.arange(COLUMNS, dtype=np.float64), np.full(COLUMNS, along[SEAM_RING]))
    fields = contractions(model, control, (line_weight[..., None] * control[line_index]).sum(1))
    skirt, skirt_index, skirt_weight = lip_skirt(model, grid, points, across)
    control_vertices, control_weights = control_places(grid, across, along)
    return LipTables(
        skin_count=len(points),
        control_rest=control.astype(np.float32),
        control_vertices=control_vertices,
        control_weights=control_weights.astype(np.float32),
        across=across.astype(np.float32),
        along=along.astype(np.float32),
        patch=patch,
        controls=index.astype(np.int32),
        weight=weight.astype(np.float32),
        rest=np.ascontiguousarray(model.vertices[patch]),
        blend=blend.ravel().astype(np.float32),
        rim=np.flatnonzero(blend.ravel() < 1.0).astype(np.int32),
        skirt=skirt,
        skirt_index=skirt_index,
        skirt_weight=skirt_weight.astype(np.float32),
        parameters=np.array([indices_of(name)[0] for name in WHOLE_LIPS], np.int32),
        width=float(_width(control)),
        roll_from=model.lips.orbicularis_oris.roll_from,
        shift=_stack([field.shift for field in fields]),
        target=_stack([field.target for field in fields]),
        pull=_stack([field.pull for field in fields]),
    )


def contract(tables: LipTables, values: Floats, found: Floats, points: Floats) -> None:
    """Orbicularis oris: p' = p + o (shift + pull (E(p) - p)) on the control points, E(p) the place on the ellipse.

    ``shift`` is rotation and extrusion (Bui et al., section 3.2, misprint corrected: a sum of displacements). It
    contracts in the steps of the vector muscles (section 3.1): each part finds the point where these have brought it so
    far. As the sum of parts is linear in p, the mean over the parts, ``found``, takes the place of p in it. In height
    the way to the ellipse is that of the point at rest: lips that smile stay where they are while they press. Before
    that, lips that the vector muscles have stretched are thinner. The vertices at the patch's edge and beyond follow
    the surface there.

    Args:
        tables: those of the face.
        values: the pose.
        found: ``(144, 3)`` m, at which x pucker, press and roll find each control point; :func:`as_they_lie` where
            nothing moves them by steps.
        points: ``(V + 144, 3)`` m, moved in place.
    """
    levels = contraction_levels(tables, values)
    control = points[tables.skin_count :]
    thinner = thinning(_width(control), tables.width) * max(np.float32(0.0), np.float32(1.0) - levels[:2].sum())
    if not levels.any() and thinner == 0.0:
        return
    rows = control.reshape(COLUMNS, ROWS, 3)
    away = rows - rows[:, RED].mean(axis=1, keepdims=True, dtype=np.float32)
    moved = (-thinner * np.array(THINNED)[:, None] * away * np.array([0, 1, 1], np.float32)).reshape(-1, 3)
    for level, shift, target, pull, x in zip(levels, tables.shift, tables.target, tables.pull, found.T, strict=True):
        moved += level * shift
        there = np.column_stack([x, tables.control_rest[:, 1]])
        moved[:, :2] += level * pull[:, None] * (target - there)
    points[tables.patch[tables.rim]] += _mixed(moved, tables.controls[tables.rim], tables.weight[tables.rim])
    points[tables.skirt] += _mixed(moved, tables.skirt_index, tables.skirt_weight)
    control += moved


def thinning(width: np.float32, rest: float) -> np.float32:
    """The part of their height and depth that lips lose whose mouth is ``width`` m wide and ``rest`` m at rest."""
    return np.float32(max(0.0, 1.0 - rest / max(float(width), rest)))


def as_they_lie(tables: LipTables, points: Floats) -> Floats:
    """``(144, 3)`` m: the x of the control points among ``points (V + 144, 3)`` m, for each of the contractions."""
    return np.repeat(points[tables.skin_count :, :1], CONTRACTIONS, axis=1)


def slice_steps(tables: LipTables, values: Floats, step: float, shares: Floats) -> None:
    """Write to ``shares (S + 1, 3)`` which part of each contraction acts in each of S steps of at most ``step``.

    The last row, what acts after them, is 0. Of what does not contract at all, all acts in the first.
    """
    ends = np.minimum(step * np.arange(len(shares))[:, None], values[tables.parameters])
    parts = np.diff(np.stack([_levels(tables, pucker, press) for pucker, press in ends]), axis=0)
    whole = parts.sum(axis=0)
    shares[:] = 0.0
    shares[0] = 1.0
    np.divide(parts, whole, out=shares[:-1], where=whole > 0.0)


def contraction_levels(tables: LipTables, values: Floats) -> Floats:
    """``(3,)``: how far pucker, press and roll are contracted; only a strong press rolls the lips in."""
    return _levels(tables, *values[tables.parameters])


def _levels(tables: LipTables, pucker: float, press: float) -> Floats:
    return np.array([pucker, press, rolled(press, tables.roll_from)], np.float32)


def rolled(press: float, start: float) -> np.float32:
    """How far a press rolls the lips in that begins to do so at ``start``."""
    beyond = max(0.0, (press - start) / (1.0 - start))
    return np.float32(beyond * beyond)


def surface(tables: LipTables, points: Floats) -> None:
    """The vertices of the patch take rest + S(u, v; moved) - S(u, v; rest), blended into the skin at its edges."""
    moved = points[tables.skin_count :] - tables.control_rest
    there = tables.rest + _mixed(moved, tables.controls, tables.weight)
    points[tables.patch] += tables.blend[:, None] * (there - points[tables.patch])


def _width(control: Floats | Doubles) -> np.float32:
    left, right = (control[ROWS * column + RED[0], 0] for column in (0, COLUMNS // 2))
    return np.float32(left - right)


def _mixed(moved: Floats, index: Indices, weight: Floats) -> Floats:
    return np.asarray((weight[:, :, None] * moved[index]).sum(1), np.float32)


def _stack(fields: list[Doubles]) -> Floats:
    return np.ascontiguousarray(np.stack(fields), np.float32)
