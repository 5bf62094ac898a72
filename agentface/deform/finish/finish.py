"""The last part of every deformer, for one that makes its skin by itself: :class:`Finish`."""

from __future__ import annotations

from agentface.conventions import Floats, read_only
from agentface.deform.finish import order
from agentface.deform.finish.order import FinishStage
from agentface.deform.geometry import FaceGeometry
from agentface.head.model import HeadModel


class Finish:
    """Gives a deformed skin its normals, its wrinkles and its neck, and turns eyes, jaw and head.

    Args:
        model: the face.
        compiled: False for the numpy forms.
    """

    def __init__(self, model: HeadModel, *, compiled: bool = True) -> None:
        self._tables = order.prepare(model)
        self._finish = order.finish
        if compiled:
            from agentface.deform.finish import order_compiled

            self._finish = order_compiled.finish

    def apply(self, values: Floats, geometry: FaceGeometry) -> None:
        """Finish one face in place, at the pose ``values (COUNT,)``: its ``vertices`` are the deformed skin."""
        first, last = int(FinishStage.SMOOTH_NORMALS), int(FinishStage.NECK)
        self._finish(first, last, self._tables, read_only(values), geometry.arrays())
