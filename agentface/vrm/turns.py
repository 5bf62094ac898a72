"""Turns as quaternions x, y, z, w of length 1, as bones have them, and the angles of this face's head and eyes.

The axes are this face's: right-handed, +Y up, the face looks along +Z. A turn is a rotation p' = R p.
"""

from __future__ import annotations

import math
from typing import Any, TypeAlias

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles

Quaternion: TypeAlias = tuple[float, float, float, float]
STILL: Quaternion = (0.0, 0.0, 0.0, 1.0)
_NEXT = (1, 2, 0)


def quaternion_of(rotation: npt.NDArray[np.floating[Any]]) -> Quaternion:
    """The quaternion of ``rotation (3, 3)``, w >= 0 (Shepperd, Journal of Guidance and Control 1(3), 1978)."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rows = rotation.tolist()
    trace = xx + yy + zz
    if trace >= max(xx, yy, zz):
        scale = 2.0 * math.sqrt(1.0 + trace)
        return (zy - yz) / scale, (xz - zx) / scale, (yx - xy) / scale, 0.25 * scale
    first = max(range(3), key=lambda axis: rows[axis][axis])
    second, third = _NEXT[first], _NEXT[_NEXT[first]]
    scale = 2.0 * math.sqrt(1.0 + rows[first][first] - rows[second][second] - rows[third][third])
    w = (rows[third][second] - rows[second][third]) / scale
    sign = math.copysign(1.0, w)
    parts = [0.0, 0.0, 0.0]
    parts[first] = sign * 0.25 * scale
    parts[second] = sign * (rows[second][first] + rows[first][second]) / scale
    parts[third] = sign * (rows[third][first] + rows[first][third]) / scale
    return parts[0], parts[1], parts[2], abs(w)


def rotation_of(quaternion: Quaternion) -> Doubles:
    """The rotation ``(3, 3)`` of a quaternion."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


def unit(quaternion: Quaternion) -> Quaternion | None:
    """The quaternion at length 1; None for one that has no direction."""
    length = math.hypot(*quaternion)
    if not (math.isfinite(length) and length > 1e-6):
        return None
    x, y, z, w = (part / length for part in quaternion)
    return x, y, z, w


def product(one: Quaternion, other: Quaternion) -> Quaternion:
    """The turn that makes ``other`` first, and then ``one``: of a bone in its parent, of the parent."""
    ax, ay, az, aw = one
    bx, by, bz, bw = other
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def inverse(quaternion: Quaternion) -> Quaternion:
    """The turn back."""
    x, y, z, w = quaternion
    return -x, -y, -z, w


def part_of(quaternion: Quaternion, share: float) -> Quaternion:
    """The turn about the same axis by a ``share``, 0..1, of its angle."""
    x, y, z, w = quaternion
    half = math.atan2(math.hypot(x, y, z), w)
    if half < 1e-9:
        return STILL
    scale = math.sin(share * half) / math.sin(half)
    return scale * x, scale * y, scale * z, math.cos(share * half)


def head_angles(turn: Quaternion) -> tuple[float, float, float]:
    """Yaw to the person's left, pitch upward and roll to the left of a head, radians: R = Y(yaw) X(-pitch) Z(-roll)."""
    rotation = rotation_of(turn)
    pitch = math.asin(min(max(rotation[1, 2], -1.0), 1.0))
    roll = math.atan2(-rotation[1, 0], rotation[1, 1])
    return math.atan2(rotation[0, 2], rotation[2, 2]), pitch, roll


def eye_angles(turn: Quaternion) -> tuple[float, float]:
    """Yaw to the person's left and pitch upward, radians, of where an eye looks; how it rolls does not matter.

    Helmholtz's angles, as those of this face's eyes: R = X(-pitch) Y(yaw).
    """
    x, y, z = rotation_of(turn)[:, 2].tolist()
    return math.asin(min(max(x, -1.0), 1.0)), math.atan2(y, z)
