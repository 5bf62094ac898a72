"""The neck: where the head turns, its skin turns less and less down to the collar.

A point p whose share of the turn is w goes to w H p + (1 - w) p, with H the head's turn. The geometry is in the head's
axes, which are turned with it, so that there it goes to w p + (1 - w) H^-1 p.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats, Indices
from agentface.head.model import HeadModel
from agentface.mesh.smoothstep import smoothstep

_FULL, _NONE = -0.10, -1.15  # eye separations below the jaw line
_SHORTEST = np.float32(1e-18)


class NeckTables(NamedTuple):
    """The skin that does not turn fully with the head.

    Attributes:
        where: ``(N,)`` int32 vertices.
        stays: ``(N,)`` float32 0..1, the part 1 - w of the turn that each leaves out.
    """

    where: Indices
    stays: Floats


def prepare(model: HeadModel) -> NeckTables:
    """The tables of a face."""
    stays = np.float32(1.0) - shares(model)
    where = np.flatnonzero(stays > 0.0).astype(np.int32)
    return NeckTables(where, np.ascontiguousarray(stays[where]))


def shares(model: HeadModel) -> Floats:
    """``(V,)`` 0..1: 1 above the jaw line from the jaw's angle to the chin and behind it, falling to 0 below."""
    angle, chin = model.landmarks["gonion_l"], model.landmarks["menton"]
    slope = (chin[1] - angle[1]) / (chin[2] - angle[2])
    line = angle[1] + slope * np.maximum(model.vertices[:, 2] - angle[2], 0.0)
    below = (model.vertices[:, 1] - line) / model.landmarks.eye_separation
    return np.asarray(smoothstep(_NONE, _FULL, below), np.float32)


def apply(tables: NeckTables, head: Floats, vertices: Floats, normals: Floats, smooth: Floats) -> None:
    """Hold the neck back in place, where ``head (4, 4)`` turns all of the rest: ``vertices (V, 3)`` m, unit normals."""
    turn, offset = head[:3, :3], head[:3, 3]
    if np.array_equal(turn, np.eye(3, dtype=np.float32)):
        return
    where, stays = tables.where, tables.stays[:, None]
    vertices[where] += stays * ((vertices[where] - offset) @ turn - vertices[where])
    for field in (normals, smooth):
        mixed = field[where] + stays * (field[where] @ turn - field[where])
        field[where] = mixed / np.maximum(np.linalg.norm(mixed, axis=1, keepdims=True), _SHORTEST)


def released(tables: NeckTables, head: Floats, vertices: Floats, normals: Floats) -> tuple[Floats, Floats]:
    """The skin as it was before :func:`apply` with the turn ``head (4, 4)``: new ``(V, 3)`` m and unit normals.

    A vertex that turns by w is then moved by linear blend skinning: w by the head, 1 - w by the body.
    """
    free, facing, turn, offset = vertices.copy(), normals.copy(), head[:3, :3], head[:3, 3]
    stays = tables.stays[:, None, None]
    back = np.linalg.inv(np.eye(3) + stays * (turn.astype(np.float64) - np.eye(3)))
    held = vertices[tables.where] + tables.stays[:, None] * (offset @ turn)
    free[tables.where] = np.einsum("ni,nij->nj", held, back)
    mixed = np.einsum("ni,nij->nj", normals[tables.where], back)
    facing[tables.where] = mixed / np.maximum(np.linalg.norm(mixed, axis=1, keepdims=True), _SHORTEST)
    return free, facing
