"""The head's turn about the top of the neck."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from agentface.conventions import Floats
from agentface.head.model import HeadModel
from agentface.parameters import indices_of

_NECK_DEPTH = -0.01  # m, of the axis behind the ears


class HeadTurnTables(NamedTuple):
    """Where the head's angles stand in a pose, and about which point it turns.

    Attributes:
        yaw, pitch, roll: indices of parameters.
        neck: ``(3,)`` float32 m.
    """

    yaw: int
    pitch: int
    roll: int
    neck: Floats


def prepare(model: HeadModel) -> HeadTurnTables:
    """The tables of a face."""
    yaw, pitch, roll = (indices_of(name)[0] for name in ("head_yaw", "head_pitch", "head_roll"))
    neck = np.array([0.0, model.landmarks["gonion_l"][1], _NECK_DEPTH], np.float32)
    return HeadTurnTables(yaw, pitch, roll, neck)


def apply(tables: HeadTurnTables, values: Floats, transform: Floats) -> None:
    """Write R p + (n - R n) into ``transform (4, 4)``, n the neck.

    R turns to the person's left, then up, then tilts to the left: R = Y(yaw) X(-pitch) Z(-roll), all three positive
    counter-clockwise about their axes.
    """
    angles = (float(values[index]) for index in (tables.yaw, tables.pitch, tables.roll))
    cy, sy, cp, sp, cr, sr = (function(angle) for angle in angles for function in (math.cos, math.sin))
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    about_x = np.array([[1, 0, 0], [0, cp, sp], [0, -sp, cp]])
    about_z = np.array([[cr, sr, 0], [-sr, cr, 0], [0, 0, 1]])
    rotation = about_y @ about_x @ about_z
    transform[:] = np.eye(4)
    transform[:3, :3] = rotation
    transform[:3, 3] = tables.neck - rotation @ tables.neck
