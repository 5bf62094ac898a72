"""``sides`` compiled."""

from __future__ import annotations

from agentface.conventions import Doubles
from agentface.kernel import kernel
from agentface.motion.sides import Sides


@kernel()
def to_sides(now: Doubles, earlier: Doubles, apart: float, sides: Sides, out: Doubles) -> None:
    """As ``to_sides_in_numpy`` of ``sides``, with the same arguments."""
    for place in range(len(out)):
        muscle = sides.muscles[place]
        value = now[muscle]
        value += apart * sides.lates[place] * (earlier[muscle] - value)
        out[place] = value * sides.gains[place]
