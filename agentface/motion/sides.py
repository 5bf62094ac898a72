"""The two sides of a pair, which never move in exact step."""

from __future__ import annotations

import numpy as np

from agentface.conventions import SIDES
from agentface.parameters import PARAMETERS


def drawn_lags(random: np.random.Generator, most_s: float) -> dict[str, float]:
    """By parameter that has a side, how much later it moves: one side of each pair, by 0 to ``most_s`` seconds."""
    pairs = [known.name[:-2] for known in PARAMETERS if known.partner and known.name.endswith(SIDES[0])]
    lags = dict(zip(pairs, random.uniform(-most_s, most_s, len(pairs)).tolist(), strict=True))
    return {
        f"{pair}_{side}": max(0.0, sign * lag)
        for pair, lag in lags.items()
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True)
    }
