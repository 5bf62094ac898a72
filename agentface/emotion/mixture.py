"""What of the six emotions a point shows that stands among them, in dimensions or appraisals."""

from __future__ import annotations

from itertools import product

import numpy as np

from agentface.conventions import Doubles

_PRICE = 0.05
"""Of each emotion's weight: of two mixtures that come as near, the one of fewer emotions is shown."""
_SPREAD = 0.005
"""Of the square of each weight, by which mixtures that are worth the same become one."""
_MOST_MADE_UP = 1.15
"""How much of what the price takes is given back."""
_AT_ONCE = 512


def mixtures(points: Doubles, emotions: Doubles, doubts: Doubles | float = 0.0) -> Doubles:
    """Weights in 0..1, ``(N, 6)``, of the emotions that come nearest to points, ``(N, M)``, with few of them.

    ``emotions`` is ``(M, 6)``, where each of them stands; the origin is no emotion. Twice as far a point has twice the
    weights, up to 1. ``doubts``, ``(6,)``, hold back emotions of which more is not known than is; without them a point
    where an emotion stands shows it alone, or nearly so where others together stand there, too.

    Source: the non-negative lasso, Tibshirani (1996), Regression shrinkage and selection via the lasso, JRSS B 58(1).
    """
    lengths = np.linalg.norm(points, axis=1, keepdims=True)
    directions = points / np.where(lengths > 0.0, lengths, 1.0)
    pull = directions @ emotions - _PRICE
    gram = emotions.T @ emotions + np.diag(np.broadcast_to(_SPREAD + np.asarray(doubts), emotions.shape[1]))
    masks, solved = _solved(gram)
    weights = np.empty_like(pull)
    for start in range(0, len(pull), _AT_ONCE):
        some = pull[start : start + _AT_ONCE]
        found = (solved @ some.T) * masks[:, :, None]
        worth = np.where((found >= 0.0).all(axis=1), (found * some.T).sum(axis=1), -np.inf)
        weights[start : start + _AT_ONCE] = found[worth.argmax(axis=0), :, np.arange(len(some))]
    reached = weights @ emotions.T
    along, square = (reached * directions).sum(axis=1), (reached**2).sum(axis=1)
    made_up = np.clip(along / np.where(square > 0.0, square, 1.0), 1.0, _MOST_MADE_UP)
    return np.clip(weights * made_up[:, None] * lengths, 0.0, 1.0)


def _solved(gram: Doubles) -> tuple[Doubles, Doubles]:
    """Every choice among the emotions, ``(64, 6)`` of 0 and 1, and the inverse of its part of ``gram``, 0 elsewhere.

    The best mixture is the stationary one of some choice; of those that have no negative weight, the one worth most.
    """
    masks = np.array(list(product((0.0, 1.0), repeat=len(gram))))
    both = masks[:, :, None] * masks[:, None, :]
    return masks, np.linalg.inv(gram * both + np.eye(len(gram)) * (1.0 - masks)[:, None, :]) * both
