"""The text of ``.fap`` files, versions 2.0 and 2.1, to :class:`FapStream` and back.

A header of version, name, frames a second and number of frames; then, for each frame, a line of 68 masks and a line of
the frame's number and the values of those FAPs whose mask is 1: four fields for FAP 1, six for FAP 2, one for each of
the others. No standard defines it; it is what MPEG-4 players have in common.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import islice
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import FASTEST_HZ
from agentface.errors import FaultList, shown
from agentface.mpeg4.fap_stream import (
    EXPRESSION,
    EXPRESSION_FIELDS,
    SLOWEST_HZ,
    VERSIONS,
    VISEME,
    VISEME_FIELDS,
    FapStream,
    Mask,
)
from agentface.mpeg4.fap_table import FAP_COUNT

LONGEST_LINE = 4096
"""Characters; 74 values of eleven digits need a fifth of it."""
_WHOLES = re.compile(r"\s*[-+]?\d{1,9}(?:\s+[-+]?\d{1,9})*\s*", re.ASCII)
_RATE = re.compile(r"\d{1,9}(?:\.\d{0,30})?|\.\d{1,30}", re.ASCII)
_WHOLE = re.compile(r"\d{1,9}", re.ASCII)
_LINE = re.compile(r"([^\r\n]*)(?:\r\n|\r|\n|\Z)")
_HIGH = {VISEME: VISEME_FIELDS, EXPRESSION: EXPRESSION_FIELDS}
_Lines = Iterator[tuple[int, str]]
_Frame = tuple[npt.NDArray[Any], ...]


def read_fap(text: str, where: str | Path = "stream.fap") -> FapStream:
    """The stream that ``text`` holds; ``where`` is what messages call it.

    Found in the wild, and read: a 69th mask, which nothing uses; frames that count from 1; tabs; lines that end in CR
    LF or CR; empty lines; comments, which begin with ``#``; blanks and backslashes in the name; no end of line after
    the last value. Values are taken as they are in both versions.

    Raises DataError with the faults of the file, 20 at most: another version, masks other than 0 and 1, what is no
    whole number, more or fewer values than the mask says, fields out of range, frames that do not count on, more or
    fewer frames than the header says.
    """
    return _Reader(text, FaultList(where)).read()


def write_fap(stream: FapStream) -> str:
    """The text of a stream; ``read_fap`` gives back the same stream."""
    rate = np.format_float_positional(stream.rate, trim="-")
    lines = [f"{stream.version} {stream.name} {rate} {len(stream)}"]
    visemes, expressions = stream.visemes.tolist(), stream.expressions.tolist()
    for frame, (mask, values) in enumerate(zip(stream.mask, stream.values, strict=True)):
        told = [*visemes[frame]] if mask[VISEME] else []
        told += expressions[frame] if mask[EXPRESSION] else []
        told += values[EXPRESSION + 1 :][mask[EXPRESSION + 1 :]].tolist()
        lines += [" ".join("01"[set_] for set_ in mask.tolist()), " ".join(map(str, [frame, *told]))]
    return "\n".join(lines) + "\n"


class _Reader:
    """Reads one text, and notes every fault on the way."""

    def __init__(self, text: str, faults: FaultList) -> None:
        self._text, self._faults = text, faults
        self._first = 0
        self._line = 0

    def read(self) -> FapStream:
        lines = self._lines()
        version, name, rate, count = self._header(lines)
        masks, values, visemes, expressions = bytearray(), bytearray(), bytearray(), bytearray()
        for mask, row, viseme, expression in self._frames(lines, count):
            masks += mask.tobytes()
            values += row.tobytes()
            visemes += viseme.tobytes()
            expressions += expression.tobytes()
        frames = len(masks) // FAP_COUNT
        if frames != count:
            self._faults.tell(self._line, "", f"{count} frames, as the header says", frames)
        self._faults.check()
        shape = (frames, -1)
        return FapStream(
            version,
            name,
            rate,
            np.frombuffer(values, np.int32).reshape(shape),
            np.frombuffer(masks, np.bool_).reshape(shape),
            np.frombuffer(visemes, np.int32).reshape(shape),
            np.frombuffer(expressions, np.int32).reshape(shape),
        )

    def _lines(self) -> _Lines:
        """What is neither empty nor a comment, with its number."""
        for number, found in enumerate(_LINE.finditer(self._text, self._text.startswith("\ufeff")), start=1):
            if found.end() > found.start():
                self._line = number
            line = found[1].strip(" \t")
            if not line or line.startswith("#"):
                continue
            if len(line) > LONGEST_LINE:
                self._faults.stop(number, "", f"a line of at most {LONGEST_LINE} characters", len(line))
            yield number, line

    def _header(self, lines: _Lines) -> tuple[str, str, float, int]:
        number, line = next(lines, (self._line or None, ""))
        expected = "a header: version, name, frames a second, number of frames"
        parts = line.split(None, 1)
        tail = parts[1].rsplit(None, 2) if len(parts) == 2 else []
        if len(tail) != 3:
            self._faults.stop(number, "header", expected, shown(line) if line else "nothing")
        version, (name, rate, count) = parts[0], tail
        if version not in VERSIONS:
            self._faults.tell(number, "version", " or ".join(VERSIONS), shown(version))
        if not (_RATE.fullmatch(rate) and SLOWEST_HZ <= float(rate) <= FASTEST_HZ):
            self._faults.tell(number, "rate", f"frames a second, {SLOWEST_HZ:g}..{FASTEST_HZ:g}", shown(rate))
        if not (_WHOLE.fullmatch(count) and int(count) >= 1):
            self._faults.tell(number, "frames", "their number, 1 or more", shown(count))
        if len(name.splitlines()) != 1 or name.strip() != name:
            self._faults.tell(number, "name", "a name without line separators", shown(name))
        self._faults.check()
        return version, name, float(rate), int(count)

    def _frames(self, lines: _Lines, count: int) -> Iterator[_Frame]:
        for frame in range(count + 1):  # one too many is told, and no more are read
            pair = list(islice(lines, 2))
            if not pair:
                return
            mask = self._mask(frame, *pair[0])
            if len(pair) < 2:
                self._faults.tell(pair[0][0], f"frame {frame}", "a line of values after the mask", "the end")
                return
            told = self._wholes(frame, *pair[1])
            yield self._frame(frame, pair[1][0], mask, told)

    def _wholes(self, frame: int, number: int, line: str) -> list[int]:
        if _WHOLES.fullmatch(line):
            return [int(word) for word in line.split()]
        wrong = next((word for word in line.split() if not _WHOLES.fullmatch(word)), line)
        self._faults.tell(number, f"frame {frame}", "whole numbers of at most nine digits", shown(wrong))
        return []

    def _mask(self, frame: int, number: int, line: str) -> Mask | None:
        told = self._wholes(frame, number, line)
        if told and len(told) not in (FAP_COUNT, FAP_COUNT + 1):
            self._faults.tell(number, f"frame {frame}", f"a mask of {FAP_COUNT} numbers", f"{len(told)} numbers")
        elif not {*told} <= {0, 1}:
            wrong = next(value for value in told if value not in (0, 1))
            self._faults.tell(number, f"frame {frame}", "masks of 0 or 1", wrong)
        elif told:
            return np.array(told[:FAP_COUNT], np.bool_)
        return None

    def _frame(self, frame: int, number: int, mask: Mask | None, told: list[int]) -> _Frame:
        row = np.zeros(FAP_COUNT, np.int32)
        high = [np.zeros(len(fields), np.int32) for fields in _HIGH.values()]
        if mask is None or not told:  # its fault is told; what follows from it is not
            return np.zeros(FAP_COUNT, np.bool_), row, *high
        if frame == 0 and told[0] == 1:
            self._first = 1
        if told[0] != frame + self._first:
            self._faults.tell(number, f"frame {frame}", f"the frame's number, {frame + self._first}", told[0])
        del told[0]
        needed = int(mask.sum()) + sum(len(_HIGH[column]) - 1 for column in _HIGH if mask[column])
        if len(told) != needed:
            self._faults.tell(number, f"frame {frame}", f"{needed} values, as the mask says", len(told))
            return mask, row, *high
        for column, fields in _HIGH.items():
            if mask[column]:
                high[column][:] = self._fields(frame, number, column, told[: len(fields)])
                del told[: len(fields)]
        row[EXPRESSION + 1 :][mask[EXPRESSION + 1 :]] = told
        return mask, row, *high

    def _fields(self, frame: int, number: int, column: int, told: list[int]) -> list[int]:
        for (field, largest), value in zip(_HIGH[column].items(), told, strict=True):
            if not 0 <= value <= largest:
                where = f"frame {frame}.FAP {column + 1} {field}"
                self._faults.tell(number, where, f"a number in 0..{largest}", value)
        return told
