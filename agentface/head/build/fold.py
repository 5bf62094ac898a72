"""The crease above the upper lid and the skin that hangs over it, which the base mesh's targets only hint at."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.config import Table
from agentface.conventions import SIDES, Doubles
from agentface.head.build.head_topology import HeadTopology
from agentface.head.ring_names import LidRing

_DECIMETRES = 0.01  # a millimetre
_SUNK = {
    LidRing.CREASE - 2: 0.2,
    LidRing.CREASE - 1: 0.65,
    LidRing.CREASE: 1.0,
    LidRing.CREASE + 1: 0.8,
    LidRing.FOLD: 0.35,
}
_HANGING = {LidRing.FOLD: 0.7, LidRing.ORBIT: 1.0, LidRing.ORBIT + 1: 0.4}
_ENDS = 0.85  # exponent: how soon the crease is deep, from the corners of the eye on

_Length = Annotated[float, Field(ge=0, le=4)]


class LidFold(Table):
    """How deep the crease above the upper lid is, how far the skin above hangs over it, and how far it juts out."""

    depth_mm: _Length = 0.0
    overhang_mm: _Length = 0.0
    bulge_mm: _Length = 0.0


def fold_lids(topology: HeadTopology, points: Doubles, fold: LidFold, centre: Doubles) -> Doubles:
    """The skin ``points (V, 3)`` in decimetres with the fold; ``centre (3,)`` is that of the left eye."""
    placed = points.copy()
    for side in SIDES:
        mirrored = np.array([1.0 if side == SIDES[0] else -1.0, 1.0, 1.0])
        rings = topology.lid_rings(side)
        first, last = points[rings[LidRing.EDGE][0]][[0, -1], 0]
        for number, (upper, _) in enumerate(rings):
            part = np.clip((points[upper, 0] - first) / (last - first), 0.0, 1.0)
            deep = np.sin(np.pi * part)[:, None] ** _ENDS * _DECIMETRES
            away = points[upper] - centre * mirrored
            out = away / np.linalg.norm(away, axis=1, keepdims=True)
            hanging, sunk = _HANGING.get(number, 0.0), _SUNK.get(number, 0.0)
            placed[upper] += deep * (hanging * fold.bulge_mm - sunk * fold.depth_mm) * out
            placed[upper, 1] -= (deep * hanging * fold.overhang_mm)[:, 0]
    return placed
