"""``blending`` compiled."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.kernel import kernel
from agentface.motion.blending import ADD, MAX, SCALE, Rows


@kernel()
def blend(rows: Rows, wants: npt.NDArray[np.bool_], wanted: Doubles, values: Doubles) -> None:
    """As ``blend_in_numpy`` of ``blending``, with the same arguments."""
    for row in range(len(rows.place)):
        if not wants[rows.channel[row]]:
            continue
        place, way, column = rows.place[row], rows.way[row], rows.column[row]
        below, asked, weight = values[place], wanted[0, column], wanted[1, column]
        if way == MAX:
            asked = np.maximum(below, asked)  # which keeps what is no number
        elif way == ADD:
            asked = below + asked
        elif way == SCALE:
            asked = below * asked
        values[place] = asked if weight == 1.0 else (1.0 - weight) * below + weight * asked
