"""Looking at poses and solving, compiled where that can be: what solvers of any features share."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.head.model import HeadModel
from agentface.kernel import can_compile
from agentface.mpeg4 import sight, solver
from agentface.mpeg4.jacobian import Looks
from agentface.mpeg4.sight import Features


class Looking:
    """The forms of :mod:`.sight` and :mod:`.solver` that run here.

    Attributes:
        solve: :func:`agentface.mpeg4.solver.solve`.
        look: :func:`agentface.mpeg4.sight.look`.
        new_sight: what a look needs, of a model and features.
        box_minimum: :func:`agentface.mpeg4.solver.box_minimum`.
    """

    def __init__(self, *, compiled: bool = True) -> None:
        self.solve: Callable[..., int] = solver.solve
        self.look: Callable[..., None] = sight.look
        self.new_sight: Callable[[HeadModel, Features], Any] = sight.PlainSight
        self.box_minimum: Callable[..., int] = solver.box_minimum
        if compiled and can_compile():
            from agentface.mpeg4 import sight_compiled, solver_compiled

            self.solve, self.box_minimum = solver_compiled.solve, solver_compiled.box_minimum
            self.look, self.new_sight = sight_compiled.look, sight_compiled.new_sight

    def looks(self, model: HeadModel, features: Features) -> Looks:
        """What looks at many poses of a face, one by one."""
        eye = self.new_sight(model, features)

        def look(poses: Floats) -> Doubles:
            out = np.empty((len(poses), len(features.matrix)))
            for values, row in zip(np.ascontiguousarray(poses, np.float32), out, strict=True):
                self.look(eye, values, row)
            return out

        return look
