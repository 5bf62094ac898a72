"""``rules/action_units.yaml``: what makes an action unit: muscles, other movements, and the artists' shapes."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from pydantic import Field

from agentface.config import Document, Table
from agentface.conventions import Floats, check_fraction
from agentface.errors import DataError, Fault, InvalidValueError, UnknownNameError, did_you_mean
from agentface.head.model import HeadModel
from agentface.parameters import MUSCLES, PARAMETERS, PLAIN_NAMES, VECTOR_MUSCLES, FacePose, indices_of, parameter_names
from agentface.resources import rules_file

_Part = Annotated[float, Field(gt=0, le=1)]
_VECTOR = frozenset(name[:-2] for name in VECTOR_MUSCLES)
_MOVES = tuple(
    name for name in parameter_names() if name.endswith("_deg") or (name in PLAIN_NAMES and name not in MUSCLES)
)
LETTERS = {"A": 0.1, "B": 0.25, "C": 0.5, "D": 0.8, "E": 1.0}
"""FACS' intensities: trace, slight, pronounced, severe, maximum. The manual gives C and D the widest parts of its scale
and no numbers; these are ours."""
SIDE_NAMES = {"left": "l", "right": "r", "l": "l", "r": "r"}
"""The person's sides as they are said."""


class ActionUnitRow(Table):
    """One action unit.

    ``muscles`` contract so far; ``moves`` are signed movements as shares of the whole, and angles as ``NAME_deg``.
    """

    name: str
    muscles: dict[str, _Part] = {}
    moves: dict[str, float] = {}
    shapes: dict[str, _Part] = {}
    strength: Annotated[float, Field(ge=0.7, le=1.4)] = 1.0


class ActionUnitsFile(Table):
    """``action_units.yaml``: rows by the number of the action unit."""

    action_units: Annotated[dict[int, ActionUnitRow], Field(min_length=1)]


@dataclass(frozen=True, slots=True)
class ActionUnit:
    """An action unit: FACS number, FACS name, contractions of muscles without side, parts of the artists' shapes.

    ``strength`` is how much of the shapes the muscles are to make. ``moves`` are by the parameter's name without side,
    shares and radians.
    """

    number: int
    name: str
    muscles: dict[str, float]
    shapes: dict[str, float] = field(default_factory=dict)
    strength: float = 1.0
    moves: dict[str, float] = field(default_factory=dict)

    @property
    def fitted(self) -> bool:
        """Whether only vector muscles make it: these are fitted to the shapes; the other parts of a face are not."""
        return bool(self.shapes) and not self.moves and self.muscles.keys() <= _VECTOR

    @property
    def has_sides(self) -> bool:
        """Whether it can be shown on one side."""
        return any(len(indices_of(name)) > 1 for name in self.parts)

    @property
    def goes_aside(self) -> bool:
        """Whether its side is where it goes."""
        return any(PARAMETERS[indices_of(name)[0]].sideways for name in self.moves) and not self.turns

    @property
    def turns(self) -> bool:
        """Whether it is one of the eyes' or the head's."""
        return any(not PARAMETERS[indices_of(name)[0]].held for name in self.moves)

    @property
    def parts(self) -> dict[str, float]:
        """Everything that it sets, by the parameter's name without side."""
        return {**self.muscles, **self.moves}

    @property
    def pose(self) -> FacePose:
        """The whole of it, on both sides."""
        return FacePose().replace(self.parts)

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
    units = {}
    for number, row in file.action_units.items():
        for muscle in row.muscles:
            if muscle not in MUSCLES:
                where = ("action_units", number, "muscles", muscle)
                document.fault(where, "a muscle without side, or jaw_open", muscle, did_you_mean(muscle, MUSCLES))
        if not row.muscles and not row.moves:
            document.fault(("action_units", number), "muscles or moves", "neither")
        moves: dict[str, float] = {}
        for name, value in row.moves.items():
            moves |= _move(document, number, name, value)
        units[number] = ActionUnit(number, row.name, dict(row.muscles), dict(row.shapes), row.strength, moves)
    document.check()
    return units


def _move(document: Document, number: int, name: str, value: float) -> dict[str, float]:
    where = ("action_units", number, "moves", name)
    if name not in _MOVES:
        what = "a signed movement without side, or an angle such as head_yaw_deg"
        document.fault(where, what, name, did_you_mean(name, _MOVES))
        return {}
    plain = name.removesuffix("_deg")
    low, high = PARAMETERS[indices_of(plain)[0]].bounds
    if not low <= value <= high:
        document.fault(where, f"a number in {low:g}..{high:g}", f"{value:g}")
        return {}
    return {plain: value if plain == name else float(np.radians(value))}


@cache
def action_units() -> dict[int, ActionUnit]:
    """The table that comes with agentface, read once."""
    return load_action_units()


def check_unit(number: Any) -> int:
    """The number of an action unit of the table, also as text with ``AU`` before it; raises UnknownNameError."""
    text = str(number).strip().upper().removeprefix("AU").strip()
    known = int(text) if text.isdecimal() and not isinstance(number, bool) else -1
    if known not in action_units():
        raise UnknownNameError("action unit", number, tuple(str(unit) for unit in sorted(action_units())))
    return known


def check_intensity(value: Any) -> float:
    """An intensity 0..1, or one of FACS' letters; raises InvalidValueError."""
    if isinstance(value, str):
        if value.strip().upper() not in LETTERS:
            raise InvalidValueError("intensity", "0..1, or a letter from A to E", value)
        return LETTERS[value.strip().upper()]
    return check_fraction("intensity", value)


def check_side(side: Any) -> str | None:
    """``l`` or ``r`` for the person's left or right, None for both; raises UnknownNameError."""
    if side is None or side == "both":
        return None
    if not isinstance(side, str) or side.lower() not in SIDE_NAMES:
        raise UnknownNameError("side", side, ("left", "right", "both"))
    return SIDE_NAMES[side.lower()]
