"""What files of poses have in common, written as JSON or as NPZ: the names of their fields, and what may be in them.

====================  ==================================================================================
``format``            ``agentface poses``
``version``           1
``name``              what the author calls it; may be left out, as may all that follow but the last two
``sound``             the file that is heard with it, relative to this one
``rate_hz``           frames a second, where the times are regular; frame k stands at k / rate_hz
``times_s``           seconds, increasing; one for each frame, needed without ``rate_hz``
``weights``           0..1, one for each parameter, or one for each parameter of each frame; 1 if left out
``units``             ``contraction``, ``opening``, ``share`` or ``rad``: that of each parameter, as a check
``parameters``        their names; others are left to whatever else moves the face
``poses``             a row of values for each frame
====================  ==================================================================================
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from agentface.conventions import FASTEST_HZ, Doubles, Floats
from agentface.errors import FaultList, did_you_mean, shown
from agentface.io.performances.reading import MOST_FRAMES, single
from agentface.motion.performance import LONGEST_S, Performance
from agentface.parameters import COUNT, HIGH, LOW, NAMES, NEUTRAL, PARAMETERS

FORMAT, VERSION = "agentface poses", 1
FIELDS = ("format", "version", "name", "sound", "rate_hz", "times_s", "weights", "units", "parameters", "poses")
_Where = tuple[str | int, ...]


def fields_of(performance: Performance) -> dict[str, Any]:
    """The fields that say all of a performance; arrays as arrays, and none for what it has not."""
    weights = np.broadcast_to(performance.weights, performance.poses.shape)
    used = np.flatnonzero(weights.any(axis=0) | (performance.poses != NEUTRAL).any(axis=0))
    used = used if len(used) else np.arange(COUNT)
    fields: dict[str, Any] = {"format": FORMAT, "version": VERSION}
    if performance.name:
        fields["name"] = performance.name
    if performance.sound is not None:
        fields["sound"] = str(performance.sound)
    if performance.rate_hz is not None:
        fields["rate_hz"] = float(performance.rate_hz)
    if performance.rate_hz is None or not _is_regular(performance):
        fields["times_s"] = performance.times_s
    rows = performance.weights[:, used]
    fields["weights"] = rows[0] if len(rows) == 1 else rows
    fields["units"] = [PARAMETERS[index].unit for index in used]
    fields["parameters"] = [NAMES[index] for index in used]
    fields["poses"] = performance.poses[:, used]
    return fields


def performance_of(
    fields: Mapping[str, Any], faults: FaultList, line: Callable[[_Where], int | None] = lambda _: None
) -> Performance:
    """The performance that fields say; numbers come as arrays. ``line`` is that of a place in the file.

    Raises DataError with the faults, as many as are looked for.
    """
    return _Reader(fields, faults, line).read()


def _is_regular(performance: Performance) -> bool:
    assert performance.rate_hz is not None  # noqa: S101 - for the type checker
    return np.array_equal(performance.times_s, np.arange(len(performance)) / performance.rate_hz)


class _Reader:
    def __init__(self, fields: Mapping[str, Any], faults: FaultList, line: Callable[[_Where], int | None]) -> None:
        self._fields, self._faults, self._line = fields, faults, line

    def read(self) -> Performance:
        for name in self._fields:
            if name not in FIELDS:
                self._tell((name,), "no such field", shown(str(name)), did_you_mean(name, FIELDS))
        for name, wanted in (("format", FORMAT), ("version", VERSION)):
            got = self._fields.get(name)
            if got != wanted or isinstance(got, bool):
                self._tell((name,), repr(wanted), "nothing" if got is None else shown(str(got)))
        places = self._places()
        self._faults.check()
        poses = self._poses(places)
        times, rate = self._times(len(poses))
        weights = self._weights(len(poses), places)
        self._faults.check()
        sound = self._text("sound")
        return Performance(
            times,
            poses,
            weights,
            rate_hz=rate,
            sound=Path(sound) if sound else None,
            name=self._text("name"),
        )

    def _tell(self, where: _Where, expected: str, got: object, hint: str = "") -> None:
        self._faults.tell(self._line(where), ".".join(map(str, where)), expected, got, hint)

    def _text(self, name: str) -> str:
        text = self._fields.get(name, "")
        if isinstance(text, str):
            return text
        self._tell((name,), "a text", shown(str(text)))
        self._faults.check()
        raise AssertionError("a fault was told")

    def _names(self, name: str) -> list[str]:
        names = self._fields.get(name)
        if isinstance(names, list) and names and all(isinstance(each, str) for each in names):
            return names
        self._tell((name,), "a list of names", "nothing" if names is None else shown(str(names)))
        return []

    def _places(self) -> list[int]:
        names = self._names("parameters")
        units = self._names("units") if "units" in self._fields else [None] * len(names)
        if len(units) != len(names) and names and units:
            self._tell(("units",), f"{len(names)} units, one for each parameter", len(units))
        for row, (name, unit) in enumerate(zip(names, units, strict=False)):
            if name not in NAMES:
                self._tell(("parameters", row), "the name of a parameter", shown(name), did_you_mean(name, NAMES))
            elif name in names[:row]:
                self._tell(("parameters", row), "each parameter once", f"{shown(name)} again")
            elif unit not in (None, PARAMETERS[NAMES.index(name)].unit):
                known = PARAMETERS[NAMES.index(name)].unit
                self._tell(("units", row), f"{known}, the unit of {name}", shown(str(unit)))
        return [NAMES.index(name) for name in names if name in NAMES]

    def _array(self, name: str, *shapes: tuple[int, ...]) -> Doubles | None:
        """The numbers of a field, of one of some shapes in which -1 is any length but 0; None for a fault."""
        array = self._fields.get(name)
        wanted = " or ".join(str(shape).replace("-1", "frames") for shape in shapes)
        if not isinstance(array, np.ndarray) or array.dtype.kind not in "fiu":
            self._tell((name,), f"numbers of shape {wanted}", "nothing" if array is None else "something else")
            return None
        fits = [
            len(shape) == array.ndim and all(n == m or (n == -1 and m) for n, m in zip(shape, array.shape, strict=True))
            for shape in shapes
        ]
        if not any(fits):
            self._tell((name,), f"numbers of shape {wanted}", f"those of {array.shape}")
            return None
        with np.errstate(invalid="ignore", over="ignore"):  # what is no finite number is told where it is looked at
            return array.astype(np.float64)

    def _poses(self, places: list[int]) -> Floats:
        values = self._array("poses", (-1, len(places)))
        if values is None:
            self._faults.check()
            raise AssertionError("a fault was told")
        if len(values) > MOST_FRAMES:
            self._faults.stop(self._line(("poses",)), "poses", f"at most {MOST_FRAMES:,} frames", len(values))
        rounded = single(values)  # at a limit, doubles may be just outside
        for frame, column in np.argwhere(~((rounded >= LOW[places]) & (rounded <= HIGH[places]))).tolist():
            known = PARAMETERS[places[column]]
            where = ("poses", frame, column)
            self._tell(where, f"{known.low:g}..{known.high:g} for {known.name}", f"{values[frame, column]:g}")
        poses = np.tile(NEUTRAL, (len(values), 1))
        poses[:, places] = rounded
        return poses

    def _times(self, count: int) -> tuple[Doubles, float | None]:
        rate = self._fields.get("rate_hz")
        if rate is not None:
            number = isinstance(rate, (int, float)) and not isinstance(rate, bool)
            if not (number and 0.0 < rate <= FASTEST_HZ):
                self._tell(("rate_hz",), f"more than 0 and at most {FASTEST_HZ:g}", shown(str(rate)))
                self._faults.check()
        if "times_s" not in self._fields and rate is not None:
            times = np.arange(count) / float(rate)
            if times[-1] > LONGEST_S:
                self._tell(("rate_hz",), f"frames until {LONGEST_S:g} s at the latest", f"{times[-1]:g} s")
            return times, float(rate)
        told = self._array("times_s", (count,))
        times = np.zeros(count) if told is None else told
        if told is None:
            return times, None
        for frame in np.flatnonzero(~((times >= 0.0) & (times <= LONGEST_S))).tolist():
            self._tell(("times_s", frame), f"seconds in 0..{LONGEST_S:g}", f"{times[frame]:g}")
        for frame in (np.flatnonzero(np.diff(times) <= 0.0) + 1).tolist():
            self._tell(("times_s", frame), f"more than {times[frame - 1]:.9g} s", f"{times[frame]:.9g} s")
        return times, None if rate is None else float(rate)

    def _weights(self, count: int, places: list[int]) -> Floats:
        full = np.zeros((1, COUNT), np.float32)
        if "weights" not in self._fields:
            full[:, places] = 1.0
            return full
        weights = self._array("weights", (len(places),), (count, len(places)))
        if weights is None:
            return full
        for place in np.argwhere(~((weights >= 0.0) & (weights <= 1.0))).tolist():
            self._tell(("weights", *place), "a number in 0..1", f"{weights[tuple(place)]:g}")
        rows = single(np.atleast_2d(weights))
        full = np.zeros((len(rows), COUNT), np.float32)
        full[:, places] = rows
        return full
