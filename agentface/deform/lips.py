"""Orbicularis oris, simple form: two displacement fields round the mouth, puckering and pressing the lips."""

from __future__ import annotations

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Doubles, Floats
from agentface.parameters import indices_of

_SEAM, _VERMILION = 0, 7


class Lips:
    """Presses and puckers the lips of one face; each contraction scales a field made at rest."""

    def __init__(self, model: HeadModel) -> None:
        fields = {"orbicularis_oris_press": _press(model), "orbicularis_oris_pucker": _pucker(model)}
        self._fields = []
        for name, field in fields.items():
            where = np.flatnonzero(np.abs(field).max(axis=1) > 1e-6)
            self._fields.append((indices_of(name)[0], where, field[where].astype(np.float32)))

    def apply(self, values: Floats, vertices: Floats) -> None:
        """Move ``vertices (V, 3)`` in place, to the parameters ``values``."""
        for index, where, field in self._fields:
            if values[index]:
                vertices[where] += values[index] * field


def _press(model: HeadModel) -> Doubles:
    """The red of the lips is rolled in and flattened between the lips; corners stay."""
    points = model.vertices.astype(np.float64)
    across, above, height, width = _mouth_frame(model, points)
    near = _fade(np.abs(above) / (2.3 * height)) * _fade(np.abs(across) / (1.15 * width)) * _front(model, points)
    field = np.zeros_like(points)
    field[:, 1] = -0.52 * above * near
    field[:, 2] = -0.16 * height * near * _fade(np.abs(above) / (1.3 * height))
    return field


def _pucker(model: HeadModel) -> Doubles:
    """The mouth is drawn together and pushed forward."""
    points = model.vertices.astype(np.float64)
    across, above, height, width = _mouth_frame(model, points)
    radius = np.hypot(across / (1.75 * width), above / (3.6 * height))
    near = _fade(radius) * _front(model, points, depth=0.030)
    field = np.zeros_like(points)
    field[:, 0] = -0.42 * across * near
    field[:, 1] = 0.12 * above * near
    field[:, 2] = 0.62 * height * near
    return field


def _mouth_frame(model: HeadModel, points: Doubles) -> tuple[Doubles, Doubles, float, float]:
    """Places relative to the lip seam: across and above it, the lips' mean height and the mouth's half width, in m."""
    seam, edge = model.lips.rings[_SEAM], model.lips.rings[_VERMILION]
    line = 0.5 * sum(np.interp(points[:, 0], *points[half[::-1], :2].T) for half in (seam.upper, seam.lower))
    middle = model.landmarks["upper_lip_middle"][1] - model.landmarks["lower_lip_middle"][1]
    above = points[:, 1] - line
    return points[:, 0], above, 0.5 * float(middle), float(points[edge.upper, 0].max())


def _front(model: HeadModel, points: Doubles, depth: float = 0.022) -> Doubles:
    """1 on the lips, fading to 0 ``depth`` metres behind the corners of the mouth."""
    corner = float(model.landmarks["mouth_corner_l"][2])
    return _fade((corner - 0.004 - points[:, 2]) / depth)


def _fade(t: Doubles) -> Doubles:
    t = np.clip(t, 0.0, 1.0)
    return 1.0 - t * t * (3.0 - 2.0 * t)
