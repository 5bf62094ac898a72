"""Live Link Face's tables of ARKit weights, both ways.

A row has a timecode, the number of values, the 52 weights, and nine angles in radians. The timecode counts frames in
its last part, ``HH:MM:SS:FF.fff``; how many make a second is not in the file: it is the least common rate that has
them, and 60, which the app records at, where less than a second was recorded. A frame that was dropped has no values,
or no row.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from agentface.arkit.stream import ANGLES, ArkitStream
from agentface.conventions import check_rate
from agentface.errors import FaultList, shown
from agentface.head.arkit import ARKIT_SHAPES
from agentface.io.performances.reading import single
from agentface.io.performances.seen_frames import SeenFrames
from agentface.io.performances.table import CsvTable, TableRow

USUAL_HZ = 60.0
_RATES = (24.0, 25.0, 30.0, 48.0, 50.0, 60.0, 120.0)
_CODE = re.compile(r"(\d{1,2}):([0-5]?\d):([0-5]?\d)[:;](\d{1,3}(?:\.\d{1,9})?)", re.ASCII)
_DAY_S = 86_400
_COLUMNS = (
    "EyeBlinkLeft", "EyeLookDownLeft", "EyeLookInLeft", "EyeLookOutLeft", "EyeLookUpLeft", "EyeSquintLeft",
    "EyeWideLeft", "EyeBlinkRight", "EyeLookDownRight", "EyeLookInRight", "EyeLookOutRight", "EyeLookUpRight",
    "EyeSquintRight", "EyeWideRight", "JawForward", "JawRight", "JawLeft", "JawOpen", "MouthClose", "MouthFunnel",
    "MouthPucker", "MouthRight", "MouthLeft", "MouthSmileLeft", "MouthSmileRight", "MouthFrownLeft",
    "MouthFrownRight", "MouthDimpleLeft", "MouthDimpleRight", "MouthStretchLeft", "MouthStretchRight",
    "MouthRollLower", "MouthRollUpper", "MouthShrugLower", "MouthShrugUpper", "MouthPressLeft", "MouthPressRight",
    "MouthLowerDownLeft", "MouthLowerDownRight", "MouthUpperUpLeft", "MouthUpperUpRight", "BrowDownLeft",
    "BrowDownRight", "BrowInnerUp", "BrowOuterUpLeft", "BrowOuterUpRight", "CheekPuff", "CheekSquintLeft",
    "CheekSquintRight", "NoseSneerLeft", "NoseSneerRight", "TongueOut",
)  # fmt: skip
"""The weights in the order of the app's own files."""
_PLACES = [ARKIT_SHAPES.index(f"{name[0].lower()}{name[1:]}") for name in _COLUMNS]


def is_live_link(head: str) -> bool:
    """Whether a first line names Live Link Face's columns."""
    names = [name.strip().lower() for name in head.split(",")]
    return "timecode" in names and "blendshapecount" in names


def read_live_link(
    lines: Iterable[str], where: str | Path = "live-link.csv", rate_hz: float | None = None
) -> ArkitStream:
    """The stream that the lines of a table hold; ``rate_hz`` is that of the timecode where it is known.

    The first frame stands at 0 s. Rows without values are dropped frames; they are left out, and noted, and so are
    weights outside of 0..1, which are brought into it. A recording may go over midnight. Raises DataError with the
    faults of the table, 20 at most: columns that miss, fields that are no numbers, times that do not increase.
    """
    faults = FaultList(where)
    table, frames = CsvTable(lines, faults), SeenFrames(faults)
    code, count = table.need("Timecode"), table.place("BlendShapeCount")
    shapes = [table.need(name) for name in ARKIT_SHAPES]
    angles = [place for place in map(table.place, ANGLES) if place is not None]
    wanted = [*shapes, *angles] if len(angles) == len(ANGLES) else shapes
    recorded = _Recorded()
    for row in table.rows():
        if table.empty(row, wanted) or (count is not None and row.fields[count].strip() in ("", "0")):
            frames.note(row.line, "a frame with values", "a dropped one, left out")
            continue
        at, values = _timecode(row, code, faults), table.numbers(row, wanted)
        if at is not None and values is not None:
            recorded.add(row.line, *at, values)
    rate = check_rate("rate_hz", recorded.rate if rate_hz is None else rate_hz)
    recorded.hand_over(rate, frames)
    times, numbers = frames.done()
    weights, turned = np.split(numbers, [len(ARKIT_SHAPES)], axis=1)
    if not turned.size:
        turned = np.zeros((len(times), len(ANGLES)))
    return ArkitStream(times, single(weights), single(turned), rate, Path(where).stem, frames.notes)


def write_live_link(stream: ArkitStream) -> str:
    """The table of a stream; its times are written to a thousandth of a frame."""
    rate = 60.0 if stream.rate_hz is None else next((each for each in _RATES if each >= stream.rate_hz), _RATES[-1])
    rows = [",".join(("Timecode", "BlendShapeCount", *_COLUMNS, *ANGLES))]
    numbers = np.concatenate([stream.weights[:, _PLACES], stream.angles], axis=1)
    for time, row in zip(stream.times_s.tolist(), numbers.astype("U").tolist(), strict=True):
        thousandths = round(time * rate * 1000.0)
        seconds, part = divmod(thousandths, round(rate * 1000.0))
        code = f"{seconds // 3600:02d}:{seconds // 60 % 60:02d}:{seconds % 60:02d}:{part / 1000.0:06.3f}"
        rows.append(",".join((code, str(numbers.shape[1]), *row)))
    return "\n".join(rows) + "\n"


class _Recorded:
    """Rows until the rate of their timecode is known."""

    def __init__(self) -> None:
        self._lines, self._seconds = array("q"), array("q")
        self._parts, self._numbers = array("d"), array("d")
        self._day = 0

    def add(self, line: int, seconds: int, part: float, numbers: list[float]) -> None:
        if self._seconds and seconds + self._day < self._seconds[-1] - _DAY_S / 2:
            self._day += _DAY_S
        self._lines.append(line)
        self._seconds.append(seconds + self._day)
        self._parts.append(part)
        self._numbers.extend(numbers)

    @property
    def rate(self) -> float:
        """The least common rate with so many frames in a second."""
        most = max(self._parts, default=0.0)
        usual = len({*self._seconds[:1], *self._seconds[-1:]}) < 2
        return next((rate for rate in _RATES if rate > most and not (usual and rate < USUAL_HZ)), most + 1.0)

    def hand_over(self, rate: float, frames: SeenFrames) -> None:
        """Put them into ``frames``, the first at 0 s."""
        width = len(self._numbers) // max(len(self._lines), 1)
        first = self._seconds[0] + self._parts[0] / rate if self._lines else 0.0
        for place, line in enumerate(self._lines):
            time = round(self._seconds[place] + self._parts[place] / rate - first, 9)
            numbers = self._numbers[place * width : (place + 1) * width]
            weights = numbers[: len(ARKIT_SHAPES)]
            if min(weights) < 0.0 or max(weights) > 1.0:
                frames.note(line, "weights in 0..1", "others, brought into it")
                numbers[: len(ARKIT_SHAPES)] = array("d", [min(max(weight, 0.0), 1.0) for weight in weights])
            if time == frames.last_s:
                frames.note(line, "each timecode once", "the one before again, left out")
            else:
                frames.add(line, time, numbers)


def _timecode(row: TableRow, place: int, faults: FaultList) -> tuple[int, float] | None:
    """Whole seconds, and frames of the next one."""
    text = row.fields[place].strip()
    found = _CODE.fullmatch(text)
    if found is None:
        faults.tell(row.line, "Timecode", "HH:MM:SS:FF.fff", shown(text))
        return None
    hours, minutes, seconds, part = found.groups()
    return 3600 * int(hours) + 60 * int(minutes) + int(seconds), float(part)
