"""Poses as JSON: for programs and for people, a line a frame."""

from __future__ import annotations

import json
import re
from array import array
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from agentface.errors import FaultList, shown
from agentface.io.performances.poses import fields_of, performance_of
from agentface.io.performances.reading import text_of
from agentface.motion.performance import Performance

LARGEST_FILE = 16 * 1024 * 1024
"""Bytes, for in memory JSON takes many times as much; what is longer is for NPZ."""
_ARRAYS = {"times_s": 1, "weights": 2, "poses": 2}
"""The fields of numbers, and how deep they may be."""
_TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[\[\]{},:]|[^\s\[\]{},:"]+')


def write_json(performance: Performance) -> str:
    """The text of a performance; :func:`read_json` gives back the same."""
    lines = []
    for name, field in fields_of(performance).items():
        if not isinstance(field, np.ndarray):
            lines.append(f'"{name}": {json.dumps(field, ensure_ascii=False)}')
        elif field.ndim == 1:
            lines.append(f'"{name}": {_row(field)}')
        else:
            lines.append(f'"{name}": [\n  ' + ",\n  ".join(map(_row, field)) + "\n ]")
    return "{\n " + ",\n ".join(lines) + "\n}\n"


def read_json(data: bytes, where: str | Path = "poses.json") -> Performance:
    """The performance that a document holds; ``where`` is what messages call it.

    Raises DataError with the faults of the document, 20 at most, each with its line.
    """
    faults = FaultList(where)
    if len(data) > LARGEST_FILE:
        faults.stop(None, "", f"at most {LARGEST_FILE:,} bytes", "more", "write longer performances as .npz")
    text = text_of(data, where)
    fields = _parsed(text, faults)
    for name, depth in _ARRAYS.items():
        if name in fields:
            fields[name] = _array(fields[name], depth)
    return performance_of(fields, faults, Lines(text).of)


class Lines:
    """The line of each field of a JSON document, and of each element of a field that is a list; read when asked."""

    def __init__(self, text: str) -> None:
        self._text = text
        self._fields: dict[str, array[int]] | None = None

    def of(self, where: Sequence[str | int]) -> int | None:
        """The line of the field, element, or whatever is in it, that ``where`` leads to; None for what is not there."""
        if self._fields is None:
            self._fields = self._found()
        lines = self._fields.get(str(where[0])) if where else None
        if lines is None:
            return None
        element = where[1] + 1 if len(where) > 1 and isinstance(where[1], int) else 0
        return lines[element] if element < len(lines) else lines[0]

    def _found(self) -> dict[str, array[int]]:
        """For each field its line, and after it those of its elements."""
        fields: dict[str, array[int]] = {}
        depth, line, end = 0, 1, 0
        key, lines = "", array("q")
        for token in _TOKEN.finditer(self._text):
            line += self._text.count("\n", end, token.start())
            end = token.start()
            first = token[0][0]
            if depth == 1 and first == '"':
                key = token[0]
            elif depth == 1 and first == ":":
                lines = fields[_name(key)] = array("q", [line])
            elif depth == 2 and first not in ",]}":
                lines.append(line)
            depth += (first in "[{") - (first in "]}")
        return fields


def _row(numbers: np.ndarray[Any, Any]) -> str:
    return f"[{', '.join(numbers.astype('U').tolist())}]"


def _name(quoted: str) -> str:
    try:
        return str(json.loads(quoted))
    except ValueError:
        return quoted


def _parsed(text: str, faults: FaultList) -> dict[str, Any]:
    def constant(name: str) -> float:
        faults.stop(None, "", "finite numbers", name)

    def pairs(found: list[tuple[str, Any]]) -> dict[str, Any]:
        fields = dict(found)
        if len(fields) < len(found):
            seen: set[str] = set()
            twice = next(name for name, _ in found if name in seen or seen.add(name))  # type: ignore[func-returns-value]
            faults.stop(Lines(text).of((twice,)), twice, "each field once", "it a second time")
        return fields

    try:
        fields = json.loads(text, parse_constant=constant, object_pairs_hook=pairs)
    except json.JSONDecodeError as error:
        faults.stop(error.lineno, "", "valid JSON", error.msg)
    except RecursionError:
        faults.stop(None, "", "a JSON document", "values nested too deeply")
    except ValueError as error:  # a number of thousands of digits
        faults.stop(None, "", "valid JSON", shown(str(error)))
    if not isinstance(fields, dict):
        faults.stop(1, "", "an object, { ... }", shown(text.strip()))
    return fields


def _array(field: Any, depth: int) -> Any:
    """Lists of numbers as an array; anything else as it is, for the reader to refuse."""
    rows = field if depth == 2 and isinstance(field, list) and field and isinstance(field[0], list) else [field]
    width = len(rows[0]) if isinstance(rows[0], list) else 0
    for row in rows:
        if not isinstance(row, list) or len(row) != width or not {*map(type, row)} <= {int, float}:
            return field
    try:
        numbers = np.array(rows, np.float64)
    except OverflowError:  # a whole number beyond a double's
        return field
    return numbers if rows is field else numbers[0]
