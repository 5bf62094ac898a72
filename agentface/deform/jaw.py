"""The jaw: the lower face turns about the hinge (Bui et al., section 3.4).

A point p that makes the share s(p) of the jaw's turn, 0..1, goes to

    p' = c + R(s(p) · a) (p − c),     a = jaw_open · widest opening,

with R the rotation about the axis parallel to X through the hinge c, positive a opening. The shares are the face's
``jaw_weights``: 1 for the chin and the middle of the lower lip, less towards the corners of the mouth, one third there,
and from there to 0 in the middle of the upper lip. Lower teeth and tongue make the whole turn.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Doubles, Floats, Indices
from agentface.parameters import indices_of

Follow = tuple[Indices, Floats]
"""For points that are not vertices, ``(C, k)`` vertices whose weighted mean, ``(C, k)``, each one's share is."""


class JawTables(NamedTuple):
    """What the jaw moves.

    Attributes:
        where: ``(N,)`` int32, rows of the points that follow the jaw.
        share: ``(N,)`` float32 0..1, the part of the turn that each makes.
        hinge: ``(2,)`` float32 m, y and z of the axis.
        widest: rad, the turn of the whole opening.
        parameter: where ``jaw_open`` stands in a pose.
    """

    where: Indices
    share: Floats
    hinge: Floats
    widest: float
    parameter: int


def prepare(model: HeadModel, follow: Follow | None = None) -> JawTables:
    """The tables of a face's skin and, after its vertices, of the points that ``follow`` it."""
    share = model.jaw_weights
    if follow is not None:
        share = np.concatenate([share, (share[follow[0]] * follow[1]).sum(axis=1)]).astype(np.float32)
    where = np.flatnonzero(share).astype(np.int32)
    return JawTables(
        where=where,
        share=np.ascontiguousarray(share[where]),
        hinge=np.array(model.jaw.pivot[1:], np.float32),
        widest=math.radians(model.jaw.widest_deg),
        parameter=indices_of("jaw_open")[0],
    )


def apply(tables: JawTables, values: Floats, points: Floats) -> None:
    """Turn ``points (P, 3)`` m in place, to the pose ``values``; a closed jaw leaves them as they are."""
    if values[tables.parameter] == 0.0:
        return
    turn = tables.share * np.float32(tables.widest * values[tables.parameter])
    cosine, sine = np.cos(turn), np.sin(turn)
    up, forward = (points[tables.where, 1:] - tables.hinge).T
    points[tables.where, 1] = tables.hinge[0] + cosine * up - sine * forward
    points[tables.where, 2] = tables.hinge[1] + sine * up + cosine * forward


def transform(tables: JawTables, values: Floats, out: Floats) -> None:
    """Write the turn of the whole jaw, that of the lower teeth and the tongue, into ``out (4, 4)``."""
    angle = tables.widest * float(values[tables.parameter])
    cosine, sine = math.cos(angle), math.sin(angle)
    rotation: Doubles = np.array([[cosine, -sine], [sine, cosine]])
    out[:] = np.eye(4)
    out[1:3, 1:3] = rotation
    out[1:3, 3] = tables.hinge - rotation @ tables.hinge
