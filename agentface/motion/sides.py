"""The two sides of a pair, which never move in exact step, nor equally far."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from agentface.conventions import SIDES, Doubles, Indices
from agentface.parameters import PARAMETERS


class Sides(NamedTuple):
    """What parameters with sides make of muscles without, ``(N,)`` each."""

    muscles: Indices
    """The place of the muscle that each is a side of."""
    lates: Doubles
    """How late it is, 0..1 of a fixed time."""
    gains: Doubles
    """How far it goes."""


def to_sides_in_numpy(now: Doubles, earlier: Doubles, apart: float, sides: Sides, out: Doubles) -> None:
    """Write into ``out (N,)`` what the sides are when the muscles are ``now (M,)`` and were ``earlier (M,)``.

    ``earlier`` is as long ago as what is wholly late; ``apart`` 0..1 is how much it all is.
    """
    np.take(now, sides.muscles, out=out)
    out += apart * sides.lates * (earlier[sides.muscles] - out)
    out *= sides.gains


def drawn_lags(random: np.random.Generator, most_s: float) -> dict[str, float]:
    """By parameter that has a side, how much later it moves: one side of each pair, by 0 to ``most_s`` seconds."""
    pairs = [known.name[:-2] for known in PARAMETERS if known.partner and known.name.endswith(SIDES[0])]
    lags = dict(zip(pairs, random.uniform(-most_s, most_s, len(pairs)).tolist(), strict=True))
    return {
        f"{pair}_{side}": max(0.0, sign * lag)
        for pair, lag in lags.items()
        for side, sign in zip(SIDES, (1.0, -1.0), strict=True)
    }
