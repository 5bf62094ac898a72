"""The solver, compiled: the numpy twin's own code with the compiled look."""

from __future__ import annotations

import numpy as np  # noqa: F401  # the twin's names

from agentface.kernel import compiled_twin
from agentface.mpeg4 import solver
from agentface.mpeg4.sight_compiled import look  # noqa: F401
from agentface.mpeg4.solver import (  # noqa: F401
    _DAMP,
    _EASE,
    _FIRM,
    _FLAT,
    _SHARE,
    _SHORT,
    _STILL,
    ROUNDS,
    SMALL,
    SWEEPS,
)

_go_on = compiled_twin(solver._go_on, globals(), error_model="numpy")
box_minimum = compiled_twin(solver.box_minimum, globals(), error_model="numpy", fastmath=True)
_learn = compiled_twin(solver._learn, globals(), error_model="numpy", fastmath=True)
_step = compiled_twin(solver._step, globals(), error_model="numpy")
solve = compiled_twin(solver.solve, globals(), error_model="numpy")
