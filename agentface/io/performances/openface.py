"""OpenFace's tables of action units (Baltrusaitis et al., FG 2018), both ways.

Source: the project's page "Output Format". ``AU12_r`` is an intensity of 0 to 5; ``gaze_angle_x`` and ``_y`` are
radians in the camera's axes; ``pose_Rx``, ``Ry`` and ``Rz`` radians about them, R = X Y Z. What is only present or
absent (``AU12_c``) is not used.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from agentface.conventions import Doubles, Floats
from agentface.errors import FaultList
from agentface.io.performances import camera
from agentface.io.performances.seen_frames import SeenFrames
from agentface.io.performances.table import CsvTable, TableRow
from agentface.io.performances.unit_columns import unit_columns
from agentface.io.performances.unit_stream import ActionUnitStream

FULL = 5.0
LEAST_CONFIDENCE = 0.5
WRITTEN = (1, 2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 20, 23, 25, 26, 45)
"""The action units of OpenFace's own tables."""
_UNIT = re.compile(r"AU(\d{1,2})_r")
_HEAD = ("pose_Rx", "pose_Ry", "pose_Rz")
_GAZE = ("gaze_angle_x", "gaze_angle_y")
_VECTORS = tuple(f"gaze_{eye}_{axis}" for eye in "01" for axis in "xyz")


def is_openface(head: str) -> bool:
    """Whether a first line names OpenFace's columns."""
    names = {name.strip() for name in head.split(",")}
    return "timestamp" in names and any(map(_UNIT.fullmatch, names))


def read_openface(lines: Iterable[str], where: str | Path = "openface.csv") -> ActionUnitStream:
    """The stream that the lines of a table hold; ``where`` is what messages call it.

    Rows without success, with a confidence under ``LEAST_CONFIDENCE``, or of another face than the first are left out,
    and noted; so are action units that the face does not have. Raises DataError with the faults of the table, 20 at
    most: columns that miss, fields that are no numbers, times that do not increase.
    """
    faults = FaultList(where)
    table, frames = CsvTable(lines, faults), SeenFrames(faults)
    time = table.need("timestamp")
    units = unit_columns(table, _UNIT, frames, faults)
    kept = _Kept(table, frames)
    head = _places(table, _HEAD)
    gaze = _places(table, _GAZE) or _places(table, _VECTORS)
    wanted = [*units.values(), *head, *gaze]
    for row in table.rows():
        if not kept.keeps(row):
            continue
        at, numbers = table.number(row, time), table.numbers(row, wanted)
        if at is not None and numbers is not None:
            _note_intensities(frames, row, numbers[: len(units)])
            frames.add(row.line, at, numbers)
    times, rows = frames.done()
    seen, turned, looked = np.split(rows, [len(units), len(units) + len(head)], axis=1)
    rotation = camera.head_rotation(turned if head else np.zeros((len(times), 3)))
    return ActionUnitStream(
        times,
        tuple(units),
        (seen / FULL).clip(0.0, 1.0).astype(np.float32),
        camera.head_angles(rotation).astype(np.float32) if head else None,
        camera.gaze_angles(_directions(looked), rotation).astype(np.float32) if gaze else None,
        name=Path(where).stem,
        notes=frames.notes,
    )


def write_openface(stream: ActionUnitStream) -> str:
    """The table of a stream, with the columns that :func:`read_openface` reads."""
    count = len(stream)
    names = ["frame", "face_id", "timestamp", "confidence", "success"]
    columns: list[Doubles | Floats] = [np.arange(1, count + 1.0), np.zeros(count), stream.times_s, *np.ones((2, count))]
    head = np.zeros((count, 3)) if stream.head is None else stream.head.astype(np.float64)
    rotation = camera.turned_head(head)
    if stream.gaze is not None:
        x, y, z = camera.seen_directions(stream.gaze.astype(np.float64), rotation).T
        names += _GAZE
        columns += [np.arctan2(x, -z), np.arctan2(y, -z)]
    if stream.head is not None:
        names += _HEAD
        columns += [*camera.camera_rotations(rotation).T]
    for number, intensity in sorted(zip(stream.units, stream.intensities.T, strict=True), key=lambda unit: unit[0]):
        names.append(f"AU{number:02d}_r")
        columns.append(FULL * intensity)
    rows = [", ".join(names)]
    rows += [",".join(f"{value + 0.0:.9g}" for value in row) for row in np.stack(columns, axis=1).tolist()]
    return "\n".join(rows) + "\n"


class _Kept:
    """Which rows are used: those of the first face, where it was seen."""

    def __init__(self, table: CsvTable, frames: SeenFrames) -> None:
        self._table, self._frames = table, frames
        self._success, self._confidence = table.place("success"), table.place("confidence")
        self._face = table.place("face_id")
        self._first: str | None = None

    def keeps(self, row: TableRow) -> bool:
        if self._face is not None:
            face = row.fields[self._face].strip()
            self._first = face if self._first is None else self._first
            if face != self._first:
                self._frames.note(row.line, f"the face {self._first!r}, the first of the file", "another, left out")
                return False
        if self._success is not None and self._table.number(row, self._success) == 0.0:
            self._frames.note(row.line, "a face that was found (success)", "none, left out")
            return False
        if self._confidence is not None:
            confidence = self._table.number(row, self._confidence)
            if confidence is not None and confidence < LEAST_CONFIDENCE:
                expected = f"a confidence of at least {LEAST_CONFIDENCE:g}"
                self._frames.note(row.line, expected, "less, left out")
                return False
        return True


def _places(table: CsvTable, names: tuple[str, ...]) -> list[int]:
    """Where these columns stand; nothing unless all of them are there."""
    places = [place for place in map(table.place, names) if place is not None]
    return places if len(places) == len(names) else []


def _note_intensities(frames: SeenFrames, row: TableRow, numbers: list[float]) -> None:
    if not all(0.0 <= number <= FULL for number in numbers):
        frames.note(row.line, f"intensities in 0..{FULL:g}", "others, brought into it")


def _directions(looked: Doubles) -> Doubles:
    """``(T, 3)`` of two angles, or of a direction of each eye."""
    if looked.shape[1] == len(_GAZE):
        limit = np.pi / 2 - 1e-3
        sideways, down = np.tan(looked.clip(-limit, limit)).T
        return np.stack([sideways, down, -np.ones(len(looked))], axis=1)
    return looked[:, :3] + looked[:, 3:]
