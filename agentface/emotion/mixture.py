"""What of the six emotions a point shows that stands among them, in dimensions or appraisals."""

from __future__ import annotations

from itertools import combinations

import numpy as np

from agentface.conventions import Doubles

_PRICE = 0.05
"""Of each emotion's weight: of two mixtures that come as near, the one of fewer emotions is shown."""
_SPREAD = 0.005
"""Of the square of each weight, by which mixtures that are worth the same become one."""
_MOST_MADE_UP = 1.15
"""How much of what the price takes is given back."""


def mixtures(points: Doubles, emotions: Doubles, doubts: Doubles | float = 0.0) -> Doubles:
    """Weights in 0..1, ``(N, 6)``, of the emotions that come nearest to points, ``(N, M)``, with few of them.

    ``emotions`` is ``(M, 6)``, where each of them stands; the origin is no emotion. Twice as far a point has twice the
    weights, up to 1. ``doubts``, ``(6,)``, hold back emotions of which more is not known than is; without them a point
    where an emotion stands shows it alone, or nearly so where others together stand there, too.

    Source: the non-negative lasso, Tibshirani (1996), Regression shrinkage and selection via the lasso, JRSS B 58(1).
    """
    count = emotions.shape[1]
    lengths = np.linalg.norm(points, axis=1)
    directions = points.T / np.where(lengths > 0.0, lengths, 1.0)
    pull = emotions.T @ directions - _PRICE
    gram = emotions.T @ emotions + np.diag(np.broadcast_to(_SPREAD + np.asarray(doubts), count))
    weights, worth = np.zeros_like(pull), np.zeros(len(points))
    for chosen in (list(some) for size in range(1, count + 1) for some in combinations(range(count), size)):
        found = np.linalg.inv(gram[np.ix_(chosen, chosen)]) @ pull[chosen]
        gained = (found * pull[chosen]).sum(axis=0)
        better = np.flatnonzero((found.min(axis=0) >= 0.0) & (gained > worth))
        worth[better] = gained[better]
        weights[:, better] = 0.0
        weights[np.ix_(chosen, better)] = found[:, better]
    reached = emotions @ weights
    along, square = (reached * directions).sum(axis=0), (reached**2).sum(axis=0)
    made_up = np.clip(along / np.where(square > 0.0, square, 1.0), 1.0, _MOST_MADE_UP)
    return np.clip((weights * made_up * lengths).T, 0.0, 1.0)
