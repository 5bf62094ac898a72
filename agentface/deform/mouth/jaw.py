"""The jaw: the lower face turns about the hinge (Bui et al., section 3.4).

A point p that makes the share s(p) of the jaw's turn, 0..1, goes to

    p' = c + R(s(p) · a) (p − c),     a = jaw_open · widest opening,

with R the rotation about the axis parallel to X through the hinge c, positive a opening. The shares are the face's
``jaw_weights``: 1 for the chin and the middle of the lower lip, less towards the corners of the mouth, one third there,
and from there to 0 in the middle of the upper lip. Lower teeth and tongue make the whole turn.

A turn alone leaves cheeks and corners of the mouth standing where the skin of a face is drawn taut against the teeth:
before it, p goes a way d(p) · jaw_open in the horizontal plane, what the artists' jawOpen has beyond the turn.
"""

from __future__ import annotations

import math
from typing import NamedTuple, TypeAlias

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.deform.lanes import LANES
from agentface.deform.mouth.lip_surface import mirrored_controls
from agentface.head.model import HeadModel
from agentface.head.resample import ResampledModel
from agentface.mesh.evening import evened
from agentface.mesh.smoothstep import falloff
from agentface.parameters import indices_of

Follow: TypeAlias = tuple[Indices, Floats]
"""For points that are not vertices, ``(C, k)`` vertices whose weighted mean, ``(C, k)``, each one's share is."""
Surface: TypeAlias = tuple[Indices, Indices, Floats, Floats]
"""Vertices ``(P,)`` of a surface that those points span, the points that act on each ``(P, k)``, how much ``(P, k)``,
and where they rest ``(C, 3)`` m."""
_CORNER = 1000.0  # vertices that a corner of the lips counts for: there the paper says the share
_PRIOR = 1e-3
_STEPS = 1500
_EVENINGS = 20
_REACH = 1.1, 1.0, 0.62
"""Eye separations from the corners of the mouth aside, up and down within which skin is drawn back."""
_BONE = 0.18, 0.45
"""Eye separations from the tip of the chin within which skin lies on the bone, and beyond which it does not."""
_TAUT = 0.4  # of what the artists' shape draws back: the rest would go through the upper teeth
JAW_SHAPE = "jawOpen"


class JawTables(NamedTuple):
    """What the jaw moves.

    Attributes:
        where: ``(N,)`` int32, rows of the points that follow the jaw.
        share: float32 0..1, the part of the turn that each makes; ``(N,)``, and 0 up to B whole blocks of LANES.
        drawn: ``(B, 2, LANES)`` float32 m, how far each goes along x and z at the whole opening.
        hinge: ``(2,)`` float32 m, y and z of the axis.
        widest: rad, the turn of the whole opening.
        parameter: where ``jaw_open`` stands in a pose.
    """

    where: Indices
    share: Floats
    drawn: Floats
    hinge: Floats
    widest: float
    parameter: int


def prepare(model: HeadModel, follow: Follow | None = None, surface: Surface | None = None) -> JawTables:
    """The tables of a face's skin and, after its vertices, of the points that ``follow`` it.

    Where these span a ``surface`` of vertices, their shares are such that the surface's are its vertices'.
    """
    share, drawn = model.jaw_weights, _drawn(model)
    if follow is not None:
        drawn = np.concatenate([drawn, (drawn[follow[0]] * follow[1][..., None]).sum(axis=1)])
        mean = (share[follow[0]] * follow[1]).sum(axis=1)
        if surface is not None:
            mean = _spanned(model, mean.astype(np.float64), surface)
        share = np.concatenate([share, mean]).astype(np.float32)
    where = np.flatnonzero((share > 0.0) | drawn.any(axis=1)).astype(np.int32)
    blocks = np.concatenate([drawn[where], np.zeros((-len(where) % LANES, 2))])
    return JawTables(
        where=where,
        share=np.append(share[where], np.zeros(-len(where) % LANES)).astype(np.float32),
        drawn=np.ascontiguousarray(np.moveaxis(blocks.reshape(-1, LANES, 2), 2, 1), np.float32),
        hinge=np.array(model.jaw.pivot[1:], np.float32),
        widest=math.radians(model.jaw.widest_deg),
        parameter=indices_of("jaw_open")[0],
    )


def _drawn(model: HeadModel) -> Doubles:
    """``(V, 2)`` m along x and z: what the artists' jawOpen has beyond the turn, evened out; 0 without that shape."""
    if isinstance(model, ResampledModel):
        return np.asarray(_drawn(model.coarse)[model.parents].mean(axis=1))
    if JAW_SHAPE not in model.shapes:
        return np.zeros((len(model.vertices), 2))
    rest = model.vertices.astype(np.float64)
    angle = math.radians(model.jaw.widest_deg) * model.jaw_weights
    up, forward = (rest[:, 1:] - model.jaw.pivot[1:]).T
    turned = np.sin(angle) * up + (np.cos(angle) - 1.0) * forward
    beyond = model.shapes[JAW_SHAPE].dense(len(rest))[:, ::2] - np.column_stack([0.0 * turned, turned])
    beyond[:, 1] = np.minimum(beyond[:, 1], 0.0)
    return _TAUT * _beside_the_mouth(model)[:, None] * evened(beyond, model.triangles, _EVENINGS)


def _beside_the_mouth(model: HeadModel) -> Doubles:
    """``(V,)`` 0..1: 1 from the middle of the lips out to the cheeks, 0 on the chin, which is bone, and far away."""
    corner = model.landmarks["mouth_corner_l"].astype(np.float64)
    aside = np.maximum(np.abs(model.vertices[:, 0]) - corner[0], 0.0)
    up, ahead = (model.vertices[:, 1:] - corner[1:]).T
    reach = np.where(up > 0.0, _REACH[1], _REACH[2])
    distance = np.sqrt((aside / _REACH[0]) ** 2 + (up / reach) ** 2 + (np.minimum(ahead, 0.0) / _REACH[0]) ** 2)
    from_chin = np.linalg.norm(model.vertices - model.landmarks["pogonion"], axis=1)
    unit = model.landmarks.eye_separation
    return falloff(distance / unit, 0.3, 1.0) * (1.0 - falloff(from_chin / unit, *_BONE))


def _spanned(model: HeadModel, prior: Doubles, surface: Surface) -> Doubles:
    """Shares ``(C,)`` of 0..1 that give the surface those of its vertices, by weighted least squares, symmetric.

    Nesterov's accelerated gradient, projected; ``prior`` is the start and what is kept where no vertex tells.
    """
    vertex, index, weight, control = surface
    hinge = np.array(model.jaw.pivot[1:])
    arm, arms = model.vertices[vertex, 1:] - hinge, control[:, 1:] - hinge
    # a point turns its vertex by as much as its arm about the hinge is long along the vertex's own
    lever = (arms[index] * arm[:, None]).sum(axis=2) / (arm**2).sum(axis=1)[:, None]
    rows = np.zeros((len(vertex), len(prior)))
    np.put_along_axis(rows, index.astype(np.int64), weight.astype(np.float64) * lever, axis=1)
    counts = np.ones(len(model.vertices))
    counts[[end for ring in model.lips.rings for end in (ring.upper[0], ring.upper[-1])]] = _CORNER
    counted = counts[vertex]
    normal = rows.T @ (counted[:, None] * rows) + _PRIOR * np.eye(len(prior))
    right = rows.T @ (counted * model.jaw_weights[vertex]) + _PRIOR * prior
    step = 1.0 / np.linalg.norm(normal, 2)
    share, ahead, pace = prior, prior, 1.0
    for _ in range(_STEPS):
        last, share = share, np.clip(ahead - step * (normal @ ahead - right), 0.0, 1.0)
        last_pace, pace = pace, 0.5 + math.sqrt(0.25 + pace * pace)
        ahead = share + (last_pace - 1.0) / pace * (share - last)
    return np.asarray(0.5 * (share + share[mirrored_controls()]))


def drawn_of(tables: JawTables) -> Floats:
    """``(N, 2)`` m: ``tables.drawn`` point by point."""
    return np.moveaxis(tables.drawn, 1, 2).reshape(-1, 2)[: len(tables.where)]


def apply(tables: JawTables, values: Floats, points: Floats) -> None:
    """Turn ``points (P, 3)`` m in place, to the pose ``values``; a closed jaw leaves them as they are."""
    if values[tables.parameter] == 0.0:
        return
    points[tables.where, ::2] += values[tables.parameter] * drawn_of(tables)
    turn = tables.share[: len(tables.where)] * np.float32(tables.widest * values[tables.parameter])
    cosine, sine = np.cos(turn), np.sin(turn)
    up, forward = (points[tables.where, 1:] - tables.hinge).T
    points[tables.where, 1] = tables.hinge[0] + cosine * up - sine * forward
    points[tables.where, 2] = tables.hinge[1] + sine * up + cosine * forward
