"""py-feat's tables of action units (Cheong et al., Affective Science 2023): its ``Fex`` data frames, written as CSV.

``AU12`` is 0 to 1. ``Pitch``, ``Roll`` and ``Yaw`` are drawn by py-feat as upward, clockwise in the picture, and to its
left; they are radians in tables that have the place of the head (``X``, ``Y``, ``Z``), and degrees in older ones. The
table has no times: ``frame`` counts the film's.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from agentface.conventions import check_rate
from agentface.errors import FaultList
from agentface.io.performances.reading import single
from agentface.io.performances.seen_frames import SeenFrames
from agentface.io.performances.table import CsvTable
from agentface.io.performances.unit_columns import unit_columns
from agentface.io.performances.unit_stream import ActionUnitStream

USUAL_HZ = 30.0
LEAST_SCORE = 0.5
_UNIT = re.compile(r"AU(\d{2})")
_HEAD = {"Yaw": -1.0, "Pitch": 1.0, "Roll": 1.0}
"""Their signs where the person's left and up are positive."""


def is_py_feat(head: str) -> bool:
    """Whether a first line names py-feat's columns."""
    names = {name.strip() for name in head.split(",")}
    return "timestamp" not in names and "frame" in names and any(map(_UNIT.fullmatch, names))


def read_py_feat(
    lines: Iterable[str], where: str | Path = "py-feat.csv", rate_hz: float = USUAL_HZ
) -> ActionUnitStream:
    """The stream that the lines of a table hold, of a film of ``rate_hz`` frames a second.

    Rows without values, with a ``FaceScore`` under ``LEAST_SCORE``, or of a second face in a frame are left out, and
    noted; so are action units that the face does not have. Raises DataError as ``read_openface`` does.
    """
    faults = FaultList(where)
    table, frames = CsvTable(lines, faults), SeenFrames(faults)
    rate = check_rate("rate_hz", rate_hz)
    frame, score = table.need("frame"), table.place("FaceScore")
    units = unit_columns(table, _UNIT, frames, faults)
    head = [place for place in map(table.place, _HEAD) if place is not None]
    head = head if len(head) == len(_HEAD) else []
    wanted = [*units.values(), *head]
    for row in table.rows():
        if table.empty(row, wanted):
            frames.note(row.line, "a face that was found", "none, left out")
            continue
        numbers, at = table.numbers(row, wanted), table.number(row, frame)
        if numbers is None or at is None:
            continue
        if score is not None and (table.number(row, score) or 0.0) < LEAST_SCORE:
            frames.note(row.line, f"a FaceScore of at least {LEAST_SCORE:g}", "less, left out")
        elif at / rate == frames.last_s:
            frames.note(row.line, "one face a frame", "another, left out")
        else:
            frames.add(row.line, at / rate, numbers)
    times, rows = frames.done()
    seen, turned = np.split(rows, [len(units)], axis=1)
    in_degrees = None in (table.place("X"), table.place("Y"), table.place("Z"))
    angles = turned * np.array([*_HEAD.values()]) if head else None
    return ActionUnitStream(
        times,
        tuple(units),
        seen.clip(0.0, 1.0).astype(np.float32),
        None if angles is None else single(np.deg2rad(angles) if in_degrees else angles),
        name=Path(where).stem,
        notes=frames.notes,
    )
