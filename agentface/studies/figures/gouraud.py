"""A mesh drawn in smooth shading: the light of each triangle's corners, interpolated, as the paper's OpenGL did."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Bytes, Doubles, Indices
from agentface.studies.figures.mesh_view import SKIN, MeshView

_LIGHT = np.array([-0.25, 0.85, 0.45]) / np.linalg.norm([-0.25, 0.85, 0.45])
_AMBIENT = 0.25
_EMPTY = 255


def smooth_picture(view: MeshView, points: Doubles, triangles: Indices, normals: Doubles) -> Bytes:
    """``(S, S, 3)``: ``points (V, 3)`` m seen by ``view``, lit by the corners' ``normals (T, 3, 3)``."""
    pixels = view.pixels(points)
    light = _AMBIENT + (1.0 - _AMBIENT) * np.clip(view.turned(normals.reshape(-1, 3)) @ _LIGHT, 0.0, 1.0)
    shades = light.reshape(-1, 3)
    bright = np.full((view.size, view.size), np.nan)
    near = np.full((view.size, view.size), -np.inf)
    for corners, shade in zip(pixels[triangles], shades, strict=True):
        _fill(bright, near, corners, shade)
    shown = np.where(np.isnan(bright)[..., None], _EMPTY, bright[..., None] * SKIN)
    return np.round(np.clip(shown, 0, 255)).astype(np.uint8)


def _fill(bright: Doubles, near: Doubles, corners: Doubles, shade: Doubles) -> None:
    """Draw one triangle: ``corners (3, 3)`` in columns, rows and depth, their light ``shade (3,)``."""
    low = np.maximum(np.floor(corners[:, :2].min(axis=0)).astype(int), 0)
    high = np.minimum(np.ceil(corners[:, :2].max(axis=0)).astype(int) + 1, bright.shape[0])
    (ax, ay), (bx, by), (cx, cy) = corners[:, :2]
    area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
    if area == 0.0 or (high <= low).any():
        return
    x, y = np.meshgrid(np.arange(low[0], high[0]) + 0.5, np.arange(low[1], high[1]) + 0.5)
    b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
    c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
    shares = np.stack([1.0 - b - c, b, c], axis=-1)
    depth = shares @ corners[:, 2]
    window = np.s_[low[1] : high[1], low[0] : high[0]]
    seen = (shares >= 0.0).all(axis=-1) & (depth > near[window])
    near[window][seen] = depth[seen]
    bright[window][seen] = (shares @ shade)[seen]
