""":class:`FapStream`: the FAPs of successive frames, each with its mask."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from agentface.conventions import check_range, check_rate
from agentface.errors import InvalidValueError
from agentface.mpeg4.fap_table import FAP_COUNT

VERSIONS = ("2.0", "2.1")
SLOWEST_HZ = 0.001
LARGEST = 999_999_999
"""Of a value, either sign."""
VISEME, EXPRESSION = 0, 1
"""The columns of the two high-level FAPs: they have no values there, but fields of their own."""
VISEME_FIELDS = {"select1": 14, "select2": 14, "blend": 63, "def": 1}
EXPRESSION_FIELDS = {"select1": 6, "intensity1": 63, "select2": 6, "intensity2": 63, "init_face": 1, "def": 1}
"""The fields of FAP 1 and FAP 2 in their order, each with its largest value (ISO/IEC 14496-2)."""

Whole = npt.NDArray[np.int32]
Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class FapStream:
    """FAPs over time.

    Attributes:
        version: ``2.0`` or ``2.1``.
        name: what its author called it: one line without blanks at its ends, and not empty.
        rate: frames a second.
        values: ``(T, 68)`` int32, FAP n at n - 1, in its own unit; 0 where it is masked, and for FAPs 1 and 2. T >= 1.
        mask: ``(T, 68)`` bool: which FAPs a frame sets.
        visemes: ``(T, 4)`` int32, the fields ``VISEME_FIELDS`` of FAP 1; 0 where it is masked.
        expressions: ``(T, 6)`` int32, the fields ``EXPRESSION_FIELDS`` of FAP 2; likewise.

    Raises InvalidValueError for anything else.
    """

    version: str
    name: str
    rate: float
    values: Whole
    mask: Mask
    visemes: Whole
    expressions: Whole

    def __post_init__(self) -> None:
        if self.version not in VERSIONS:
            raise InvalidValueError("version", " or ".join(VERSIONS), self.version)
        if self.name.strip() != self.name or len(self.name.splitlines()) != 1:
            raise InvalidValueError("name", "one line without blanks at its ends", self.name)
        if check_rate("rate", self.rate) < SLOWEST_HZ:
            raise InvalidValueError("rate", f"at least {SLOWEST_HZ:g} frames a second", self.rate)
        mask = np.array(self.mask, np.bool_)
        if mask.ndim != 2 or mask.shape[1] != FAP_COUNT or not len(mask):
            raise InvalidValueError("mask", f"the shape (T, {FAP_COUNT}) with one frame or more", mask.shape)
        kept = {"mask": mask, "values": _whole("values", self.values, (len(mask), FAP_COUNT))}
        kept["values"][~mask] = 0
        kept["values"][:, [VISEME, EXPRESSION]] = 0
        for name, column, fields in (
            ("visemes", VISEME, VISEME_FIELDS),
            ("expressions", EXPRESSION, EXPRESSION_FIELDS),
        ):
            kept[name] = _whole(name, getattr(self, name), (len(mask), len(fields)))
            kept[name][~mask[:, column]] = 0
            _check_fields(name, kept[name], fields)
        for name, array in kept.items():
            array.flags.writeable = False
            object.__setattr__(self, name, array)

    @classmethod
    def measured(cls, faps: npt.ArrayLike, rate: float, name: str = "agentface", version: str = "2.1") -> FapStream:
        """Of what was measured, ``(T, 68)`` numbers, FAP n at n - 1, rounded: all low-level FAPs, and no others."""
        values = np.rint(np.asarray(faps, np.float64)).astype(np.int32)
        mask = np.ones(values.shape, np.bool_)
        mask[:, [VISEME, EXPRESSION]] = False
        visemes, expressions = (np.zeros((len(values), len(f)), np.int32) for f in (VISEME_FIELDS, EXPRESSION_FIELDS))
        return cls(version, name, rate, values, mask, visemes, expressions)

    def __len__(self) -> int:
        return len(self.mask)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, FapStream):
            return NotImplemented
        head = (self.version, self.name, self.rate) == (other.version, other.name, other.rate)
        names = ("values", "mask", "visemes", "expressions")
        return head and all(np.array_equal(getattr(self, name), getattr(other, name)) for name in names)

    __hash__ = None  # type: ignore[assignment]  # arrays may be large


def check_fap(number: Any, value: Any) -> tuple[int, float]:
    """The number of a low-level FAP and a value, as an int and a float; raises InvalidValueError."""
    whole = not isinstance(number, bool) and isinstance(number, int | np.integer)
    if not whole or not EXPRESSION + 2 <= number <= FAP_COUNT:
        hint = "FAPs 1 and 2 come as fields in a whole frame" if number in (1, 2) else ""
        raise InvalidValueError("FAP", f"a number in {EXPRESSION + 2}..{FAP_COUNT}", number, hint)
    return int(number), check_range(f"FAP {number}", value, -LARGEST, LARGEST)


def check_fields(name: str, fields: Any, table: dict[str, int]) -> tuple[int, ...]:
    """The fields of FAP 1 or 2, each in its range; raises InvalidValueError."""
    got = tuple(fields)
    if len(got) != len(table):
        raise InvalidValueError(name, f"{len(table)} values: {', '.join(table)}", len(got))
    for value, (field, largest) in zip(got, table.items(), strict=True):
        if isinstance(value, bool) or value not in range(largest + 1):
            raise InvalidValueError(f"{name} {field}", f"a whole number in 0..{largest}", value)
    return tuple(int(value) for value in got)


def _whole(name: str, array: Any, shape: tuple[int, int]) -> Any:
    given = np.array(array)
    if given.shape != shape or given.dtype.kind not in "iu":
        raise InvalidValueError(name, f"whole numbers of shape {shape}", f"{given.dtype} of shape {given.shape}")
    wrong = given[(given > LARGEST) | (given < -LARGEST)]
    if len(wrong):
        raise InvalidValueError(name, f"numbers in {-LARGEST}..{LARGEST}", int(wrong[0]))
    return given.astype(np.int32)


def _check_fields(name: str, rows: Whole, fields: dict[str, int]) -> None:
    for column, (field, largest) in enumerate(fields.items()):
        wrong = rows[(rows[:, column] < 0) | (rows[:, column] > largest), column]
        if len(wrong):
            raise InvalidValueError(f"{name} {field}", f"a number in 0..{largest}", int(wrong[0]))
