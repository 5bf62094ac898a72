"""The elements whose volume the tissue keeps: prisms between a triangle of the epidermis and the one under it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from agentface.conventions import Doubles, Indices


class Elements(Protocol):
    """Any solid elements of the lattice: E of them, each between C of its nodes."""

    @property
    def corners(self) -> Indices:
        """``(E, C)`` nodes."""

    def volumes(self, points: Doubles) -> Doubles:
        """``(E,)`` mm3 with the nodes at ``points (N, 3)`` mm."""

    def gradients(self, points: Doubles) -> Doubles:
        """``(E, C, 3)`` mm2: how the volumes change with each corner."""


@dataclass(frozen=True, eq=False)
class Prisms:
    """Prisms of six nodes: the triangle above, counter-clockwise from outside, then the one below it.

    V = -(H . N) / 36, with H the sum of the three ways down and N the mean normal; exact for straight edges between
    the triangles, and linear in each corner.
    """

    corners: Indices

    def volumes(self, points: Doubles) -> Doubles:
        """``(P,)`` mm3."""
        down, normal, *_ = self._parts(points)
        return np.asarray(-(down * normal).sum(axis=1) / 36.0)

    def gradients(self, points: Doubles) -> Doubles:
        """``(P, 6, 3)`` mm2."""
        down, normal, top, low = self._parts(points)
        result = np.empty((len(top), 6, 3))
        for corner in range(3):
            after, last = (corner + 1) % 3, (corner + 2) % 3
            above, below = top[:, after] - top[:, last], low[:, after] - low[:, last]
            result[:, corner] = (normal - np.cross(2.0 * above + below, down)) / 36.0
            result[:, 3 + corner] = (-normal - np.cross(2.0 * below + above, down)) / 36.0
        return result

    def _parts(self, points: Doubles) -> tuple[Doubles, Doubles, Doubles, Doubles]:
        top, low = points[self.corners[:, :3]], points[self.corners[:, 3:]]
        t1, t2, b1, b2 = top[:, 1] - top[:, 0], top[:, 2] - top[:, 0], low[:, 1] - low[:, 0], low[:, 2] - low[:, 0]
        normal = np.cross(t1, 2.0 * t2 + b2) + np.cross(b1, 2.0 * b2 + t2)
        return (low - top).sum(axis=1), normal, top, low
