"""``rules/action_units.yaml``: which muscles and which artists' shapes make an action unit."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import Floats
from agentface.errors import DataError, Fault, did_you_mean
from agentface.head.model import HeadModel
from agentface.parameters import MUSCLES, VECTOR_MUSCLES
from agentface.resources import rules_file

_Part = Annotated[float, Field(gt=0, le=1)]
_VECTOR = frozenset(name[:-2] for name in VECTOR_MUSCLES)


class ActionUnitRow(Table):
    """One action unit."""

    name: str
    muscles: Annotated[dict[str, _Part], Field(min_length=1)]
    shapes: Annotated[dict[str, _Part], Field(min_length=1)]
    strength: Annotated[float, Field(ge=0.7, le=1.4)] = 1.0


class ActionUnitsFile(Table):
    """``action_units.yaml``: rows by the number of the action unit."""

    action_units: Annotated[dict[int, ActionUnitRow], Field(min_length=1)]


@dataclass(frozen=True, slots=True)
class ActionUnit:
    """An action unit: FACS number, FACS name, contractions of muscles without side, parts of the artists' shapes.

    ``strength`` is how much of the shapes the muscles are to make.
    """

    number: int
    name: str
    muscles: dict[str, float]
    shapes: dict[str, float]
    strength: float

    @property
    def fitted(self) -> bool:
        """Whether only vector muscles make it: these are fitted to the shapes; the other parts of a face are not."""
        return self.muscles.keys() <= _VECTOR

    def shape(self, model: HeadModel) -> Floats:
        """``(V, 3)`` m: the sum of the artists' shapes on a face; raises DataError when it has not all of them."""
        missing = [name for name in self.shapes if name not in model.shapes]
        if missing:
            path = model.folder / "head.glb"
            raise DataError(
                [Fault(path, None, f"skin.{name}", "a morph target of this name", "none") for name in missing]
            )
        count = len(model.vertices)
        parts = (np.float32(part) * model.shapes[name].dense(count) for name, part in self.shapes.items())
        return sum(parts, 0 * model.vertices)


def load_action_units(path: str | Path | None = None) -> dict[int, ActionUnit]:
    """The table at ``path``, or the one that comes with agentface; raises DataError with all faults."""
    path = None if path is None else Path(path)
    document = Document(path or rules_file("action_units.yaml"))
    file = document.parse(ActionUnitsFile)
    for number, row in file.action_units.items():
        for muscle in row.muscles:
            if muscle not in MUSCLES:
                where = ("action_units", number, "muscles", muscle)
                document.fault(where, "a muscle without side, or jaw_open", muscle, did_you_mean(muscle, MUSCLES))
    document.check()
    return {
        number: ActionUnit(number, row.name, dict(row.muscles), dict(row.shapes), row.strength)
        for number, row in file.action_units.items()
    }
