"""The head's turn about the top of the neck."""

from __future__ import annotations

import math

import numpy as np

from agentface.anatomy.model import HeadModel
from agentface.conventions import Floats
from agentface.parameters import indices_of

_NECK_DEPTH = -0.01  # m, of the axis behind the ears


def turn(yaw: float, pitch: float, roll: float = 0.0) -> Floats:
    """``(3, 3)``: turn to the person's left, then up, then tilt to the left; radians."""
    cy, sy, cp, sp, cr, sr = (f(a) for a in (yaw, pitch, roll) for f in (math.cos, math.sin))
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_x = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    about_z = np.array([[cr, sr, 0], [-sr, cr, 0], [0, 0, 1]])
    return (about_y @ about_x @ about_z).astype(np.float32)


class PoseTransforms:
    """The head's turn about the top of the neck."""

    def __init__(self, model: HeadModel) -> None:
        self._head = [indices_of(name)[0] for name in ("head_yaw", "head_pitch", "head_roll")]
        self._neck = np.array([0.0, float(model.landmarks["gonion_l"][1]), _NECK_DEPTH], np.float32)

    def head(self, values: Floats, transform: Floats) -> None:
        """Write the head's turn into ``transform (4, 4)``."""
        rotation = turn(*(float(values[index]) for index in self._head))
        transform[:] = np.eye(4)
        transform[:3, :3] = rotation
        transform[:3, 3] = self._neck - rotation @ self._neck
