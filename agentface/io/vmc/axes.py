"""Bones in the axes of the VMC protocol, and in this face's.

The protocol has Unity's: left-handed, +Y up, the avatar looks along +Z, its left is -X. A face here has +X to its left:
one way and back, x changes its sign, and of a turn the parts about y and z do. That holds for avatars of VRM 0 as well:
their files look along -Z and come into Unity with z negated, which is the same.
"""

from __future__ import annotations

from typing import TypeAlias

from agentface.vrm.turns import Quaternion

Position: TypeAlias = tuple[float, float, float]
AXES = ("unity", "gltf")
"""What may be said of a stream: the protocol's axes, or right-handed ones as those of this face and of glTF."""


def position_between(axes: str, position: Position) -> Position:
    """A position in metres of ours in ``axes``, or the other way round."""
    x, y, z = position
    return (x, y, z) if axes == "gltf" else (-x, y, z)


def turn_between(axes: str, turn: Quaternion) -> Quaternion:
    """A turn of ours in ``axes``, or the other way round."""
    x, y, z, w = turn
    return turn if axes == "gltf" else (x, -y, -z, w)
