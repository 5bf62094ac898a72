"""A plain round-necked shirt, lofted from the neck outward, that covers where the head ends."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats, Indices
from agentface.head.model import HeadModel
from agentface.view.gl.drawn_mesh import DrawnMesh
from agentface.view.parts.rigid import rigid_mesh

_AROUND, _ROWS = 72, 16
_SHOULDER = (0.215, 0.105)
_DROP = 0.22


def shirt(model: HeadModel) -> tuple[Floats, Indices, Floats]:
    """Vertices ``(N, 3)`` metres, triangles, and ``(N, 2)``: the turn from the side 0..pi, metres from the collar."""
    chin = float(model.landmarks["menton"][1])
    neck = model.vertices[
        (model.vertices[:, 1] < chin - 0.008) & (model.vertices[:, 2] < model.landmarks["menton"][2] - 0.025)
    ]
    axis_z = 0.5 * float(neck[:, 2].min() + neck[:, 2].max())
    turn = np.linspace(0, 2 * np.pi, _AROUND, endpoint=False)  # 0 the person's left, a quarter the front
    front = np.sin(turn)
    collar = chin - 0.028 - 0.014 * np.clip(front, -0.4, 1)
    start = _radius(neck, axis_z, turn, collar) + 0.004
    far = 1 / np.hypot(np.cos(turn) / _SHOULDER[0], front / _SHOULDER[1])
    rows = []
    # the collar's inside and its rounded edge, then outward over the shoulders
    for inset, height in ((-0.004, -0.010), (0.0, 0.0), (0.0018, 0.0012), (0.0034, 0.0)):
        rows.append(_row(start + inset, collar + height, turn, axis_z))
    for t in np.linspace(0.0, 1.0, _ROWS)[1:]:
        spread = start + 0.0034 + (far - start) * t
        fall = 0.055 * t + (_DROP - 0.055) * t**4 + (0.030 * t * np.clip(front, 0, 1))
        rows.append(_row(spread, (collar + (chin - 0.035 - collar) * t) - fall, turn, axis_z))
    vertices = np.concatenate(rows).astype(np.float32)
    i = np.arange(_AROUND)
    j = (i + 1) % _AROUND
    quads = [np.stack([i, i + _AROUND, j], axis=1) + row * _AROUND for row in range(len(rows) - 1)]
    quads += [np.stack([j, i + _AROUND, j + _AROUND], axis=1) + row * _AROUND for row in range(len(rows) - 1)]
    steps = np.linalg.norm(np.diff(np.stack(rows), axis=0), axis=2).mean(1)
    away = np.repeat(np.concatenate([[0.0, *np.cumsum(steps)]]) - steps[0], _AROUND)
    weave = np.stack([np.tile(np.minimum(turn, 2 * np.pi - turn), len(rows)), away], axis=1)
    return vertices, np.concatenate(quads)[:, ::-1].astype(np.int32), weave.astype(np.float32)


def shirt_mesh(model: HeadModel) -> DrawnMesh:
    """The shirt for ``shaders/cloth.vert.glsl``."""
    vertices, triangles, weave = shirt(model)
    return rigid_mesh(vertices, triangles, np.zeros((len(vertices), 4), np.float32), weave)


def _row(radius: Doubles, height: Doubles, turn: Doubles, axis_z: float) -> Doubles:
    return np.stack([radius * np.cos(turn), height, axis_z + radius * np.sin(turn)], axis=1)


def _radius(neck: Floats, axis_z: float, turn: Doubles, height: Doubles) -> Doubles:
    """The neck's radius at each angle and height: the mean of its vertices, weighted by nearness."""
    x, z = neck[:, 0].astype(np.float64), neck[:, 2] - axis_z
    reach, at = np.hypot(x, z), np.arctan2(z, x)
    apart = np.angle(np.exp(1j * (turn[:, None] - at[None])))
    away = (apart / 0.22) ** 2 + ((height[:, None] - neck[None, :, 1]) / 0.010) ** 2
    weights = np.exp(-np.minimum(away, 60.0))
    return np.asarray((weights * reach).sum(1) / weights.sum(1))
