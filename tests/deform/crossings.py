"""Which edges of one mesh pass through triangles of another: Moeller and Trumbore 1997, with a grid of boxes first."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

Doubles = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int32]


def edges_of(triangles: Indices) -> Indices:
    """``(E, 2)`` the edges of ``triangles (T, 3)``, each once."""
    pairs = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    return np.unique(np.sort(pairs, axis=1), axis=0)


def crossings(points: Doubles, edges: Indices, others: Doubles, triangles: Indices) -> Indices:
    """``(N, 2)``: rows of ``edges`` over ``points`` and of ``triangles`` over ``others`` that meet."""
    a, b = points[edges[:, 0]], points[edges[:, 1]]
    corners = others[triangles]
    low, high = np.minimum(a, b), np.maximum(a, b)
    lowest, highest = corners.min(axis=1), corners.max(axis=1)
    # what lies outside the box round all of the other mesh meets nothing
    some = np.flatnonzero((low <= highest.max(axis=0)).all(axis=1) & (high >= lowest.min(axis=0)).all(axis=1))
    if not len(some):
        return np.empty((0, 2), np.int32)
    inside = (lowest <= high[some].max(axis=0)).all(axis=1) & (highest >= low[some].min(axis=0)).all(axis=1)
    few = np.flatnonzero(inside)
    near = np.ones((len(some), len(few)), bool)
    for axis in range(3):
        near &= low[some, None, axis] <= highest[None, few, axis]
        near &= high[some, None, axis] >= lowest[None, few, axis]
    e, t = np.nonzero(near)
    e, t = some[e], few[t]
    origin, ray = a[e], b[e] - a[e]
    first, one, two = corners[t, 0], corners[t, 1] - corners[t, 0], corners[t, 2] - corners[t, 0]
    p = np.cross(ray, two)
    determinant = (one * p).sum(1)
    sound = np.abs(determinant) > 1e-18
    scale = np.where(sound, determinant, 1.0)
    s = origin - first
    u = (s * p).sum(1) / scale
    q = np.cross(s, one)
    v = (ray * q).sum(1) / scale
    w = (two * q).sum(1) / scale
    hit = sound & (u >= 0) & (v >= 0) & (u + v <= 1) & (w >= 0) & (w <= 1)
    return np.stack([e[hit], t[hit]], axis=1).astype(np.int32)
