"""``blending`` compiled."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.kernel import kernel
from agentface.motion.blending import ADD, MAX, SCALE, Claims


@kernel()
def blend(claims: Claims, wants: npt.NDArray[np.bool_], wanted: Doubles, values: Doubles) -> None:
    """As ``blend_in_numpy`` of ``blending``, with the same arguments."""
    for row in range(len(claims.place)):
        if not wants[claims.channel[row]]:
            continue
        place, way, column = claims.place[row], claims.way[row], claims.column[row]
        below, asked, weight = values[place], wanted[0, column], wanted[1, column]
        if way == MAX:
            asked = np.maximum(below, asked)  # which keeps what is no number
        elif way == ADD:
            asked = below + asked
        elif way == SCALE:
            asked = below * asked
        values[place] = asked if weight == 1.0 else (1.0 - weight) * below + weight * asked
