"""The movement of the lower teeth, compiled; the numpy twin is :mod:`.teeth`."""

from __future__ import annotations

import math

from agentface.conventions import Floats
from agentface.deform.finish.teeth import TeethTables
from agentface.deform.morphs_compiled import jaw_slide
from agentface.kernel import kernel


@kernel(error_model="numpy")
def apply(tables: TeethTables, values: Floats, out: Floats) -> None:
    """Write the movement at the pose ``values`` into ``out (4, 4)``."""
    angle = tables.widest * values[tables.parameter]
    cosine, sine = math.cos(angle), math.sin(angle)
    ahead, aside = jaw_slide(tables.slides, values)
    up, forward = -tables.hinge[0], ahead - tables.hinge[1]
    out[:] = 0.0
    out[0, 0] = out[3, 3] = 1.0
    out[1, 1] = out[2, 2] = cosine
    out[1, 2], out[2, 1] = -sine, sine
    out[0, 3] = aside
    out[1, 3] = tables.hinge[0] + (cosine * up - sine * forward)
    out[2, 3] = tables.hinge[1] + (sine * up + cosine * forward)
