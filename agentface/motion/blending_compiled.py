"""``blending`` compiled."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.kernel import kernel
from agentface.motion.blending import ADD, MAX, SCALE, Wishes


@kernel()
def blend(wishes: Wishes, wants: npt.NDArray[np.bool_], wanted: Doubles, values: Doubles) -> None:
    """As ``blend_in_numpy`` of ``blending``, with the same arguments."""
    for row in range(len(wishes.place)):
        if not wants[wishes.channel[row]]:
            continue
        place, way, column = wishes.place[row], wishes.way[row], wishes.column[row]
        below, asked, weight = values[place], wanted[0, column], wanted[1, column]
        if way == MAX:
            asked = np.maximum(below, asked)  # which keeps what is no number
        elif way == ADD:
            asked = below + asked
        elif way == SCALE:
            asked = below * asked
        values[place] = asked if weight == 1.0 else (1.0 - weight) * below + weight * asked
