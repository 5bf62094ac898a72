"""The solver, compiled: the numpy twin's own code with the compiled look."""

from __future__ import annotations

import numpy as np  # noqa: F401  # the twin's names

from agentface.kernel import compiled_twin
from agentface.mpeg4 import solver
from agentface.mpeg4.sight_compiled import look  # noqa: F401
from agentface.mpeg4.solver import (  # noqa: F401
    DAMP,
    EASE,
    FIRM,
    FLAT,
    NEAR,
    ROUNDS,
    SHARE,
    SHORT,
    SMALL,
    STILL,
    SWEEPS,
)

whole_step = compiled_twin(solver.whole_step, globals(), error_model="numpy")
box_minimum = compiled_twin(solver.box_minimum, globals(), error_model="numpy", fastmath=True)
learn = compiled_twin(solver.learn, globals(), error_model="numpy", fastmath=True)
next_step = compiled_twin(solver.next_step, globals(), error_model="numpy")
solve = compiled_twin(solver.solve, globals(), error_model="numpy")
