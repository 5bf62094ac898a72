"""Skin at rest without edges that are all but folded: muscles would turn them over."""

from __future__ import annotations

import numpy as np

from agentface.conventions import SIDES, Doubles
from agentface.head.build.head_topology import HeadTopology
from agentface.head.ring_names import LidRing
from agentface.mesh.evening import evened

_SHARPEST_DEG, _SHARPEST_LID_DEG = 45.0, 80.0
_PASSES = 40


def relaxed(topology: HeadTopology, points: Doubles) -> Doubles:
    """The skin ``points (V, 3)`` evened out where an edge is sharper than it may be; lips, mouth and ears stay."""
    triangles = topology.skin.triangles
    ends, pairs = _edges(topology)
    lids = np.zeros(len(points), np.bool_)
    for side in SIDES:
        for upper, lower in topology.lid_rings(side)[: LidRing.ORBIT + 1]:
            lids[upper + lower] = True
    flattest = np.cos(np.radians(np.where(lids[ends].any(axis=1), _SHARPEST_LID_DEG, _SHARPEST_DEG)))
    smooth = ~(topology.material[ends].max(axis=1) > 0.0).any(axis=1)
    for _ in range(_PASSES):
        a, b, c = (points[triangles[:, i]] for i in range(3))
        across = np.cross(b - a, c - a)
        across /= np.linalg.norm(across, axis=1, keepdims=True)
        sharp = smooth & ((across[pairs[:, 0]] * across[pairs[:, 1]]).sum(axis=1) < flattest)
        if not sharp.any():
            break
        beside = np.zeros(len(points), np.bool_)
        beside[triangles[pairs[sharp]].ravel()] = True
        points = evened(points, triangles, 1, beside & ~(topology.material > 0.0).any(axis=1))
    return points


def _edges(topology: HeadTopology) -> tuple[np.typing.NDArray[np.int64], np.typing.NDArray[np.int64]]:
    """The ends ``(E, 2)`` of the edges between two triangles, and those two."""
    triangles = topology.skin.triangles
    ends = np.sort(np.concatenate([triangles[:, [i, (i + 1) % 3]] for i in range(3)]), axis=1)
    order = np.lexsort(ends.T)
    same = (ends[order[1:]] == ends[order[:-1]]).all(axis=1)
    pairs = np.stack([order[:-1][same], order[1:][same]], axis=1)
    return ends[pairs[:, 0]].astype(np.int64), pairs % len(triangles)
