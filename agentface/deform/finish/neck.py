"""The neck: where the head turns, its skin turns less and less down to the collar."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Floats
from agentface.head.model import HeadModel

_FULL, _NONE = -0.10, -1.15  # eye separations below the jaw line


class Neck:
    """The part of the skin that does not turn fully with the head.

    A point ``p`` at the share ``w`` goes to ``w H p + (1 - w) p``, with ``H`` the head's turn.
    """

    def __init__(self, model: HeadModel) -> None:
        share = shares(model)
        self._where = np.flatnonzero(share < 1.0)
        self._share = share[self._where][:, None]

    def hold(self, head: Floats, vertices: Floats, normals: Floats) -> None:
        """Move ``vertices (V, 3)`` and turn ``normals`` in place, so that ``head (4, 4)`` brings them home.

        The picture turns all of the skin by ``head``: what is to stay is turned back before.
        """
        turn = head[:3, :3]
        if np.array_equal(turn, np.eye(3, dtype=np.float32)):
            return
        for field, offset in ((vertices, head[:3, 3]), (normals, np.zeros(3, np.float32))):
            kept = field[self._where]
            field[self._where] = self._share * kept + (1.0 - self._share) * ((kept - offset) @ turn)


def shares(model: HeadModel) -> Floats:
    """``(V,)`` 0..1: 1 above the jaw line from the jaw's angle to the chin and behind it, falling to 0 below."""
    angle, chin = model.landmarks["gonion_l"], model.landmarks["menton"]
    slope = (chin[1] - angle[1]) / (chin[2] - angle[2])
    line = angle[1] + slope * np.maximum(model.vertices[:, 2] - angle[2], 0.0)
    below = (model.vertices[:, 1] - line) / model.landmarks.eye_separation
    t = np.clip((below - _NONE) / (_FULL - _NONE), 0.0, 1.0)
    return np.asarray(t * t * (3.0 - 2.0 * t), np.float32)
