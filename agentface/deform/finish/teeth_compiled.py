"""The turn of the lower teeth, compiled; the numpy twin is :mod:`.teeth`."""

from __future__ import annotations

import math

from agentface.conventions import Floats
from agentface.deform.finish.teeth import TeethTables
from agentface.kernel import kernel


@kernel(error_model="numpy")
def apply(tables: TeethTables, values: Floats, out: Floats) -> None:
    """Write the turn at the pose ``values`` into ``out (4, 4)``."""
    angle = tables.widest * values[tables.parameter]
    cosine, sine = math.cos(angle), math.sin(angle)
    out[:] = 0.0
    out[0, 0] = out[3, 3] = 1.0
    out[1, 1] = out[2, 2] = cosine
    out[1, 2], out[2, 1] = -sine, sine
    out[1, 3] = tables.hinge[0] - (cosine * tables.hinge[0] - sine * tables.hinge[1])
    out[2, 3] = tables.hinge[1] - (sine * tables.hinge[0] + cosine * tables.hinge[1])
