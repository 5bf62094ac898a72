"""The columns of a table that hold action units which the face has."""

from __future__ import annotations

import re

from agentface.errors import FaultList
from agentface.facs.action_units import action_units
from agentface.io.performances.seen_frames import SeenFrames
from agentface.io.performances.table import CsvTable


def unit_columns(table: CsvTable, name: re.Pattern[str], frames: SeenFrames, faults: FaultList) -> dict[int, int]:
    """Where each action unit stands, by number, which is the first group of its column's ``name``.

    One that ``rules/action_units.yaml`` does not have is noted in ``frames``. A table without any that it has is a
    fault, which ends the reading.
    """
    found: dict[int, int] = {}
    for place, column in enumerate(table.columns):
        unit = name.fullmatch(column)
        if unit and int(unit[1]) in action_units():
            found.setdefault(int(unit[1]), place)
        elif unit:
            frames.note(table.line, "an action unit that the face has", f"{column}, left out")
    if not found:
        faults.stop(table.line, "", "a column of an action unit that the face has", "none")
    return found
