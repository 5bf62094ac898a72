"""The jaw: the lower face turns about the hinge (Bui et al., section 3.4)."""

from __future__ import annotations

import math

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Floats
from agentface.parameters import indices_of


class Jaw:
    """Opens the jaw of one face: each vertex turns by its share, lower teeth and tongue by the whole angle."""

    def __init__(self, model: HeadModel) -> None:
        self._index = indices_of("jaw_open")[0]
        self._widest = math.radians(model.jaw.widest_deg)
        self._pivot = np.array(model.jaw.pivot, np.float32)
        self._where = np.flatnonzero(model.jaw_weights > 1e-3)
        self._share = model.jaw_weights[self._where]

    def apply(self, values: Floats, vertices: Floats, transform: Floats) -> None:
        """Turn ``vertices (V, 3)`` in place and write the jaw's own ``transform (4, 4)``."""
        angle = self._widest * float(values[self._index])
        transform[:] = _about_x(angle, self._pivot)
        if angle == 0.0:
            return
        turn = angle * self._share
        cosine, sine = np.cos(turn), np.sin(turn)
        arm = vertices[self._where] - self._pivot
        vertices[self._where, 1] = self._pivot[1] + cosine * arm[:, 1] - sine * arm[:, 2]
        vertices[self._where, 2] = self._pivot[2] + sine * arm[:, 1] + cosine * arm[:, 2]


def _about_x(angle: float, pivot: Floats) -> Floats:
    cosine, sine = math.cos(angle), math.sin(angle)
    matrix = np.eye(4, dtype=np.float32)
    matrix[1:3, 1:3] = [[cosine, -sine], [sine, cosine]]
    matrix[:3, 3] = pivot - matrix[:3, :3] @ pivot
    return matrix
