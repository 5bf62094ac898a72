""":class:`Layout`: what a binary record holds, told to whoever reads it; the bytes of a record, and back.

Little endian, field after field, nothing between them. A reader needs only the list that ``as_json`` gives.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import Doubles
from agentface.errors import InvalidValueError

_TYPES = {
    name: np.dtype(f"<{name[0]}{int(name[1:]) // 8}") for name in ("u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64")
}
_MOST = 1 << 20


@dataclass(frozen=True, slots=True)
class Field:
    """Numbers of one kind.

    Attributes:
        name: what they are; two fields of one name are the first and the second part of the same numbers.
        type: ``u8``, ``i8``, ``u16``, ``i16``, ``u32``, ``i32``, ``f32`` or ``f64``.
        count: how many there are.
        scale: what a stored number is multiplied by: one for all, or one each.
    """

    name: str
    type: str
    count: int = 1
    scale: float | tuple[float, ...] = 1.0

    def as_json(self) -> dict[str, Any]:
        """As a reader is told it."""
        scale = list(self.scale) if isinstance(self.scale, tuple) else self.scale
        return {"name": self.name, "type": self.type, "count": self.count, "scale": scale}


class Layout:
    """The fields of a record; raises InvalidValueError for fields that cannot be.

    Attributes:
        fields: in their order.
        size: bytes of a record.
    """

    def __init__(self, fields: Sequence[Field]) -> None:
        self.fields = tuple(_checked(field) for field in fields)
        self._counts: dict[str, int] = {}
        for field in self.fields:
            self._counts[field.name] = self._counts.get(field.name, 0) + field.count
        self._blocks = [_Block(kind, tuple(run)) for kind, run in groupby(self.fields, key=lambda field: field.type)]
        self.size = sum(block.kind.itemsize * block.count for block in self._blocks)

    @classmethod
    def from_json(cls, told: Any) -> Layout:
        """The layout that a reader was told; raises InvalidValueError."""
        if not isinstance(told, list) or not all(isinstance(row, dict) for row in told):
            raise InvalidValueError("fields", "a list of objects", type(told).__name__)
        rows = []
        for row in told:
            scale = row.get("scale", 1.0)
            scale = tuple(scale) if isinstance(scale, list) else scale
            rows.append(Field(row.get("name", ""), row.get("type", ""), row.get("count", 1), scale))
        return cls(rows)

    def as_json(self) -> list[dict[str, Any]]:
        """As a reader is told it."""
        return [field.as_json() for field in self.fields]

    def encode(self, values: Mapping[str, npt.ArrayLike]) -> bytes:
        """The record of ``values`` by name; whole numbers are rounded, and what is past their range is its end.

        Raises InvalidValueError for a name that is missing, another count, or what is not finite.
        """
        rows = {name: self._row(name, values) for name in self._counts}
        at = dict.fromkeys(rows, 0)
        return b"".join(block.encode(rows, at) for block in self._blocks)

    def decode(self, record: bytes) -> dict[str, Doubles]:
        """What a record holds, by name; raises InvalidValueError for one of another length."""
        if len(record) != self.size:
            raise InvalidValueError("record", f"{self.size} bytes", len(record), "read the layout that came before it")
        found: dict[str, list[Doubles]] = {}
        start = 0
        for block in self._blocks:
            for name, part in block.decode(record, start):
                found.setdefault(name, []).append(part)
            start += block.kind.itemsize * block.count
        return {name: np.concatenate(parts) for name, parts in found.items()}

    def _row(self, name: str, values: Mapping[str, npt.ArrayLike]) -> Doubles:
        if name not in values:
            raise InvalidValueError("record", f"{name} among the values", ", ".join(values))
        row = np.asarray(values[name], np.float64).reshape(-1)
        if len(row) != self._counts[name]:
            raise InvalidValueError(name, f"{self._counts[name]} numbers", len(row))
        return row


class _Block:
    """Fields of one type that stand side by side: one run of numbers."""

    def __init__(self, kind: str, fields: tuple[Field, ...]) -> None:
        self.fields, self.kind = fields, _TYPES[kind]
        self.count = sum(field.count for field in fields)
        scales = [np.broadcast_to(np.asarray(field.scale, np.float64), field.count) for field in fields]
        self._scale = np.concatenate(scales)
        self._whole = self.kind.kind in "iu"
        self._limits = (np.iinfo(self.kind).min, np.iinfo(self.kind).max) if self._whole else (0, 0)

    def encode(self, rows: Mapping[str, Doubles], at: dict[str, int]) -> bytes:
        parts = []
        for field in self.fields:
            start = at[field.name]
            parts.append(rows[field.name][start : start + field.count])
            at[field.name] = start + field.count
        numbers = np.concatenate(parts) / self._scale
        if not np.isfinite(numbers).all():
            bad = next(
                field.name for field, part in zip(self.fields, parts, strict=True) if not np.isfinite(part).all()
            )
            raise InvalidValueError(bad, "finite numbers", "others")
        if self._whole:
            numbers = np.rint(numbers).clip(*self._limits)
        return numbers.astype(self.kind).tobytes()

    def decode(self, record: bytes, start: int) -> list[tuple[str, Doubles]]:
        numbers = np.frombuffer(record, self.kind, self.count, start) * self._scale
        ends = np.cumsum([field.count for field in self.fields])
        return [(field.name, numbers[end - field.count : end]) for field, end in zip(self.fields, ends, strict=True)]


def _checked(field: Field) -> Field:
    if not isinstance(field.name, str) or not field.name:
        raise InvalidValueError("field", "a name", field.name)
    if field.type not in _TYPES:
        raise InvalidValueError(f"type of {field.name}", f"one of {', '.join(_TYPES)}", field.type)
    if isinstance(field.count, bool) or not isinstance(field.count, int) or not 1 <= field.count <= _MOST:
        raise InvalidValueError(f"count of {field.name}", f"a whole number in 1..{_MOST}", field.count)
    try:
        scale = np.asarray(field.scale, np.float64)
    except (TypeError, ValueError):
        scale = np.zeros(())
    if scale.shape not in ((), (field.count,)) or not (np.isfinite(scale) & (scale > 0.0)).all():
        raise InvalidValueError(f"scale of {field.name}", "a number above 0, or one for each", field.scale)
    return field
