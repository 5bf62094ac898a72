"""The numbers of a muscle of the tissue that its fit may turn, and how far: it stays the muscle it is named after."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from agentface.conventions import Doubles
from agentface.tissue.tissue_file import LinearRow, MuscleRow, SheetRow, SphincterRow

_BONE_END, _SKIN_END = 0.40, 0.25
"""How far the two ends may go from where the row has them, in eye separations."""
_APART = 0.5
"""The least between ``fall_near``, ``fall_start`` and ``fall_finish``, in eye separations."""
EXACT = 12
"""Digits that change nothing."""


@dataclass(frozen=True, slots=True)
class Knob:
    """A number of a row: the keys and the index that lead to it, and between what it may be turned."""

    where: tuple[str | int, ...]
    low: float
    high: float


def knobs(row: MuscleRow) -> list[Knob]:
    """What may be turned of a row, within ranges round the row's own numbers, or within the same for all of a kind."""
    if isinstance(row, SphincterRow):
        return _of_sphincter(row)
    ends = [
        Knob((end, "offset", axis), offset - far, offset + far)
        for end, anchor, far in (("origin", row.origin, _BONE_END), ("insertion", row.insertion, _SKIN_END))
        for axis, offset in enumerate(anchor.offset)
    ]
    return [*ends, *(_of_sheet() if isinstance(row, SheetRow) else _of_cone(row))]


def _of_sheet() -> list[Knob]:
    return [Knob(("half_width",), 0.11, 0.76), Knob(("above",), 0.11, 1.14), Knob(("below",), 0.08, 0.57)]


def _of_cone(row: LinearRow) -> list[Knob]:
    start, finish = row.fall_start, row.fall_finish
    return [
        Knob(("zone_deg",), 0.65 * row.zone_deg, 1.6 * row.zone_deg),
        Knob(("fall_near",), 0.0, 0.8 * start),
        Knob(("fall_start",), 0.6 * start, 1.3 * start),
        Knob(("fall_finish",), 0.7 * finish, 1.4 * finish),
    ]


def _of_sphincter(row: SphincterRow) -> list[Knob]:
    (_, y, z), (wide, high) = row.centre.offset, row.radii
    return [
        Knob(("centre", "offset", 1), y - 0.25, y + 0.25),
        Knob(("centre", "offset", 2), z - 0.23, z + 0.26),
        Knob(("radii", 0), 0.75 * wide, 1.5 * wide),
        Knob(("radii", 1), 0.75 * high, 1.5 * high),
        Knob(("crest",), 0.3, 0.9),
        Knob(("upper",), 0.0, 1.0),
        Knob(("outward",), -0.5, 1.0),
    ]


def values_of(row: MuscleRow, its_knobs: list[Knob]) -> Doubles:
    """``(K,)``: where the knobs of a row stand."""
    content = row.model_dump()
    return np.array([_holder(content, knob)[knob.where[-1]] for knob in its_knobs])


def turned(row: MuscleRow, its_knobs: list[Knob], values: Doubles, strength: float, digits: int = EXACT) -> MuscleRow:
    """The row with its knobs at ``values (K,)`` and with another strength, rounded to ``digits`` after the point.

    The places where a cone begins, pulls most and ends are pushed apart where they are out of order.
    """
    content = row.model_dump()
    for knob, value in zip(its_knobs, values.tolist(), strict=True):
        _holder(content, knob)[knob.where[-1]] = round(value, digits)
    if isinstance(row, LinearRow):
        content["fall_start"] = max(content["fall_start"], round(content["fall_near"] + _APART, digits))
        content["fall_finish"] = max(content["fall_finish"], round(content["fall_start"] + _APART, digits))
    content["strength"] = round(strength, digits)
    return type(row).model_validate(content)


def _holder(content: dict[str, Any], knob: Knob) -> Any:
    """The table or list of a row that the knob's number is in."""
    holder: Any = content
    for key in knob.where[:-1]:
        holder = holder[key]
    return holder
