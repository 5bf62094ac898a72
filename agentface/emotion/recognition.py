"""The emotions that contractions show: the fuzzy rules, backwards.

Of the faces that the rules make of one or two emotions, the nearest one; then its two intensities are moved as long as
that comes nearer, and one that makes no difference is left out.
"""

from __future__ import annotations

from itertools import combinations, product

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.emotion.inference import Inference
from agentface.emotion.state import EMOTIONS

_LEVELS = np.linspace(0.0, 1.0, 5)
_STEPS = 0.125, 0.06, 0.03, 0.015
_AT_ONCE = 4096
"""Faces that are compared at once: memory stays bounded."""
_AROUND = np.array([way for way in product((-1.0, 0.0, 1.0), repeat=2) if any(way)])


def states_shown(
    inference: Inference, contractions: npt.ArrayLike, moved: npt.NDArray[np.bool_] | None = None
) -> Doubles:
    """``(N, 6)`` in 0..1: of one emotion or two, what comes nearest to ``contractions (N, len(MUSCLES))``.

    ``moved (len(MUSCLES),)`` are the muscles that are compared; all where it is None.
    """
    asked = np.asarray(contractions, np.float64)
    chosen = np.ones(asked.shape[1], np.bool_) if moved is None else moved
    known = _known_states()
    faces = inference.course(known)[:, chosen]
    parts = [
        _nearest(inference, asked[first : first + _AT_ONCE, chosen], chosen, known, faces)
        for first in range(0, len(asked), _AT_ONCE)
    ]
    return np.concatenate([np.zeros((0, len(EMOTIONS))), *parts])


def _known_states() -> Doubles:
    rows = [np.zeros(len(EMOTIONS))]
    for one, other in combinations(range(len(EMOTIONS)), 2):
        for levels in product(_LEVELS, repeat=2):
            row = np.zeros(len(EMOTIONS))
            row[[one, other]] = levels
            rows.append(row)
    return np.unique(rows, axis=0)


def _nearest(
    inference: Inference, asked: Doubles, chosen: npt.NDArray[np.bool_], known: Doubles, faces: Doubles
) -> Doubles:
    squares = (faces**2).sum(axis=1) - 2.0 * asked @ faces.T
    states = known[squares.argmin(axis=1)]
    own = np.argsort(-states, axis=1, kind="stable")[:, :2]
    rows = np.arange(len(states))[:, None]
    best = ((inference.course(states)[:, chosen] - asked) ** 2).sum(axis=1)
    for step in _STEPS:
        for way in step * _AROUND:
            tried = states.copy()
            tried[rows, own] = np.clip(tried[rows, own] + way, 0.0, 1.0)
            away = ((inference.course(tried)[:, chosen] - asked) ** 2).sum(axis=1)
            nearer = away < best
            states[nearer], best[nearer] = tried[nearer], away[nearer]
    alone = states * (states == states.max(axis=1, keepdims=True))
    away = ((inference.course(alone)[:, chosen] - asked) ** 2).sum(axis=1)
    return np.where((away <= best)[:, None], alone, states)
