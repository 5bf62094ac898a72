"""Heads and eyes as a camera sees them, and as the face turns them.

A camera's axes point to the right of the picture, down, and away from it; the person in front of it looks against the
third. The face's point to the person's left, up and forward: the first is the same, the others are reversed.
"""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles

_REVERSED = np.diag([1.0, -1.0, -1.0])


def head_rotation(rotations: Doubles) -> Doubles:
    """``(T, 3, 3)`` in the face's axes, of ``(T, 3)`` radians about the camera's: R = X(x) Y(y) Z(z)."""
    x, y, z = (_about(axis, angle) for axis, angle in enumerate(rotations.T))
    turned: Doubles = _REVERSED @ x @ y @ z @ _REVERSED
    return turned


def camera_rotations(rotation: Doubles) -> Doubles:
    """``(T, 3)`` radians about the camera's axes, of ``(T, 3, 3)`` in the face's: what :func:`head_rotation` takes."""
    seen = _REVERSED @ rotation @ _REVERSED
    return np.stack(
        [
            np.arctan2(-seen[:, 1, 2], seen[:, 2, 2]),
            np.arcsin(seen[:, 0, 2].clip(-1.0, 1.0)),
            np.arctan2(-seen[:, 0, 1], seen[:, 0, 0]),
        ],
        axis=1,
    )


def head_angles(rotation: Doubles) -> Doubles:
    """Yaw, pitch and roll ``(T, 3)`` of rotations ``(T, 3, 3)``, R = Y(yaw) X(-pitch) Z(-roll) as the head turns."""
    return np.stack(
        [
            np.arctan2(rotation[:, 0, 2], rotation[:, 2, 2]),
            np.arcsin(rotation[:, 1, 2].clip(-1.0, 1.0)),
            np.arctan2(-rotation[:, 1, 0], rotation[:, 1, 1]),
        ],
        axis=1,
    )


def turned_head(angles: Doubles) -> Doubles:
    """The rotations ``(T, 3, 3)`` of yaw, pitch and roll ``(T, 3)``."""
    turned: Doubles = _about(1, angles[:, 0]) @ _about(0, -angles[:, 1]) @ _about(2, -angles[:, 2])
    return turned


def gaze_angles(directions: Doubles, rotation: Doubles) -> Doubles:
    """Yaw and pitch of the eyes in the head, ``(T, 2)``, of directions ``(T, 3)`` that the camera sees.

    As the eyes turn (:mod:`agentface.deform.eyes.eyeballs`): yaw in a plane that pitch raises.
    """
    x, y, z = np.einsum("tji,tj->ti", rotation, directions @ _REVERSED).T
    return np.stack([np.arctan2(x, np.hypot(y, z)), np.arctan2(y, z)], axis=1)


def seen_directions(gaze: Doubles, rotation: Doubles) -> Doubles:
    """The directions ``(T, 3)`` that the camera sees of eyes ``(T, 2)`` in a head."""
    yaw, pitch = gaze.T
    inside = np.stack([np.sin(yaw), np.cos(yaw) * np.sin(pitch), np.cos(yaw) * np.cos(pitch)], axis=1)
    seen: Doubles = np.einsum("tij,tj->ti", rotation, inside) @ _REVERSED
    return seen


def _about(axis: int, angle: Doubles) -> Doubles:
    """Rotations ``(T, 3, 3)``, counter-clockwise about one axis."""
    rotation = np.broadcast_to(np.eye(3), (len(angle), 3, 3)).copy()
    one, other = (axis + 1) % 3, (axis + 2) % 3
    rotation[:, one, one] = rotation[:, other, other] = np.cos(angle)
    rotation[:, other, one] = np.sin(angle)
    rotation[:, one, other] = -np.sin(angle)
    return rotation
