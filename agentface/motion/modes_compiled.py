"""``modes`` compiled."""

from __future__ import annotations

import math

from agentface.conventions import Doubles
from agentface.kernel import kernel


@kernel()
def mean(told: Doubles, end: int, ticks: float, out: Doubles) -> None:
    """As ``mean_in_numpy`` of ``modes``, with the same arguments."""
    out[:] = told[end - 1]
    if ticks <= 1.0:
        return
    whole = 0.0
    out[:] = 0.0
    for age in range(math.ceil(ticks)):
        share = min(ticks - age, 1.0)
        for i in range(out.shape[0]):
            for j in range(i, out.shape[1]):
                out[i, j] += share * told[end - 1 - age, i, j]
                whole += share * told[end - 1 - age, i, j]
    if whole > 0.0:
        out /= whole
    else:
        out[:] = told[end - 1]
