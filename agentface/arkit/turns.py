"""The nine angles that Live Link Face writes beside the weights, and the turns of head and eyes that they are.

Radians, with the signs of Unreal Engine's rotators, which the app is made for: yaw to the person's right, pitch
downward, roll to the person's left; R = yaw, then pitch, then roll, as the head turns here. Source: Epic's plug-in
for ARKit, which turns ARKit's quaternion (x, y, z, w), whose axes are those of this face, into (-z, x, y, -w).
"""

from __future__ import annotations

import numpy as np

from agentface.arkit.stream import ANGLES
from agentface.conventions import Doubles, Floats
from agentface.parameters import HIGH, LOW, indices_of

HEAD = [indices_of(f"head_{turn}")[0] for turn in ("yaw", "pitch", "roll")]
HEAD_ANGLES = [ANGLES.index(f"Head{turn}") for turn in ("Yaw", "Pitch", "Roll")]
_SIGNS = np.array([-1.0, -1.0, 1.0])
"""Of a pose's yaw, pitch and roll: they go to the person's left, upward and to the person's left."""


def head_of(angles: Floats) -> Floats:
    """``(T, 3)`` yaw, pitch and roll as in a pose, as far as the head turns, of ``(T, 9)`` in the order of ANGLES."""
    return np.asarray(np.clip(_SIGNS * angles[:, HEAD_ANGLES], LOW[HEAD], HIGH[HEAD]), np.float32)


def angles_of(poses: Floats, eyes: Doubles) -> Floats:
    """``(T, 9)`` of ``(T, COUNT)`` poses, and of eyes ``(T, 2, 2)``: yaw to the left and pitch upward of each."""
    angles = np.zeros((len(poses), len(ANGLES)))
    angles[:, HEAD_ANGLES] = _SIGNS * poses[:, HEAD]
    for side, name in enumerate(("LeftEye", "RightEye")):
        places = [ANGLES.index(f"{name}{turn}") for turn in ("Yaw", "Pitch")]
        angles[:, places] = _SIGNS[:2] * eyes[:, side]
    return np.asarray(angles + 0.0, np.float32)  # no negative zeros
