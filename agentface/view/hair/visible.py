"""Which pieces of strands can be seen from a direction: those on the near side that no other hair hides."""

from __future__ import annotations

import numpy as np

from agentface.conventions import Doubles, Floats

Chosen = np.typing.NDArray[np.intp]
Flags = np.typing.NDArray[np.bool_]
_CELL = 0.005
_FACING_AWAY = -0.55
"""Cosine; the shader hides less, for a direction stands for those near to it."""
_HIDDEN_BEHIND = 0.003
"""Metres that the hair in front must be nearer."""
_SKIN_MOVES = 0.012
_BETWEEN = 6
_FREE = 0.03
"""Metres below the centre, from where hair hangs beside the neck and is seen from the other side."""


def on_near_side(points: Floats, towards: Doubles) -> Chosen:
    """Those of the strands ``points (N, P, 3)`` round the origin that are not wholly on the side that faces away."""
    outward = points.copy()
    free = outward[..., 1] < -_FREE
    outward[..., 1] = np.maximum(outward[..., 1], -0.25 * np.hypot(outward[..., 0], outward[..., 2]))
    away = outward @ towards.astype(np.float32) < _FACING_AWAY * np.linalg.norm(outward, axis=2)
    return np.flatnonzero((free | ~away).any(1))


def before_skin(points: Floats, skin: Floats, eye: Doubles) -> Flags:
    """``(N,)``: which of ``points (N, 3)`` the ``skin (M, 3)`` does not surely hide from any ``eye`` near this one."""
    seen, face = (_seen_from(eye, places) for places in (points, skin))
    low = np.minimum(seen.min(0), face.min(0))[:2] - 2 * _CELL
    shape = ((np.maximum(seen.max(0), face.max(0))[:2] - low) / _CELL).astype(int) + 3
    hiding = np.full(int(shape.prod()), -np.inf, np.float32)
    place, below = (_cells(places, low, shape) for places in (seen, face))
    np.maximum.at(hiding, below, face[:, 2] - np.float32(_SKIN_MOVES))
    return np.asarray(seen[:, 2] > _all_round(hiding.reshape(shape)).ravel()[place] - _HIDDEN_BEHIND)


def unhidden(points: Floats, sides: Floats, lift: Floats, skin: Floats, eye: Doubles) -> Chosen:
    """Of the pieces between the points of strands ``points (N, P, 3)`` those that nothing hides, the nearest first.

    Strand and piece in one number, ``strand * (P - 1) + piece``. The ``eye`` looks at the origin. Strands reach
    ``sides (N, P, 3)`` metres to both sides, and count as ``lift (N, P)`` metres nearer. Other strands hide, and the
    ``skin (M, 3)``. What hides has to do so for a cell and all its neighbours, so that an eye stands for those
    near to it, and a skin at rest for one that moves.
    """
    if not len(points):
        return np.empty(0, np.intp)
    face = _seen_from(eye, skin, -_SKIN_MOVES)
    seen = _seen_from(eye, np.stack([points - sides, points, points + sides], axis=1), lift[:, None])
    longest = float(np.linalg.norm(np.diff(points, axis=1), axis=2).max())
    parts = np.linspace(0, 1, int(min(longest / _CELL + 2, _BETWEEN)), dtype=np.float32)[:, None]
    dense = seen[:, :, :-1, None] * (1 - parts) + seen[:, :, 1:, None] * parts
    low = np.minimum(dense.min((0, 1, 2, 3)), face.min(0))[:2] - 2 * _CELL
    shape = ((np.maximum(dense.max((0, 1, 2, 3)), face.max(0))[:2] - low) / _CELL).astype(int) + 3
    hiding = np.full((2, int(shape.prod())), -np.inf, np.float32)
    place, below = (_cells(places, low, shape) for places in (dense, face))
    np.maximum.at(hiding[0], place.ravel(), dense[..., 2].ravel())
    np.maximum.at(hiding[1], below, face[:, 2])
    # each for itself: together they would close the gap between the face and the hair beside it
    grid = _all_round(hiding.reshape(2, *shape))
    shown = (dense[..., 2] > grid.max(0).ravel()[place] - _HIDDEN_BEHIND).any((1, 3))
    depth = np.where(shown, dense[..., 2].mean((1, 3)), -np.inf).ravel()
    return np.asarray(np.argsort(-depth, kind="stable")[: int(shown.sum())])


def _seen_from(eye: Doubles, points: Floats, nearer: Floats | float = 0.0) -> Floats:
    """``(..., 3)`` m: points to the right, up and towards an ``eye`` that looks at the origin, in perspective."""
    distance = float(np.linalg.norm(eye))
    towards = eye / distance
    right = np.cross([0.0, 1.0, 0.0], towards)
    right /= max(float(np.linalg.norm(right)), 1e-9)
    seen = points @ np.stack([right, np.cross(towards, right), towards]).T.astype(np.float32)
    seen[..., 2] += np.asarray(nearer, np.float32)
    seen[..., :2] *= distance / np.maximum(distance - seen[..., 2:], 0.1 * distance)
    return np.asarray(seen)


def _cells(seen: Floats, low: Floats, shape: Chosen) -> Chosen:
    return np.asarray(((seen[..., :2] - low) / _CELL).astype(np.intp) @ np.array([shape[1], 1]))


def _all_round(hiding: Floats) -> Floats:
    """Depths ``(..., H, W)`` that a cell and all its neighbours have."""
    for axis in (-2, -1):
        hiding = np.minimum(hiding, np.minimum(np.roll(hiding, 1, axis), np.roll(hiding, -1, axis)))
    return hiding
