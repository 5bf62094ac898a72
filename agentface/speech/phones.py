""":class:`Phone`: one speech sound and when it is said."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from agentface.conventions import check_range
from agentface.errors import InvalidValueError

LONGEST_S = 3600.0
"""The latest time of a phone: speech is said in pieces that are far shorter."""
OVERLAP_S = 1e-3
"""By so much two phones may overlap: times that come in single precision are not exact."""
_LONGEST_SYMBOL = 16


@dataclass(frozen=True, slots=True)
class Phone:
    """One speech sound; of zero length where an aligner found no room for it.

    Attributes:
        symbol: in any of the alphabets of ``rules/phones.yaml``.
        start_s: when it begins, seconds from the beginning of what is said; below 0 for one that has begun before.
        end_s: when it ends, not before ``start_s``.

    Raises InvalidValueError. Whether the symbol is known is checked where the mouth is asked to say it.
    """

    symbol: str
    start_s: float
    end_s: float

    def __post_init__(self) -> None:
        if not isinstance(self.symbol, str) or not 0 < len(self.symbol.strip()) <= _LONGEST_SYMBOL:
            raise InvalidValueError("phone", f"a symbol of 1 to {_LONGEST_SYMBOL} characters", self.symbol)
        start, end = (
            check_range(f"{what} of phone {self.symbol}", value, -LONGEST_S, LONGEST_S)
            for what, value in (("start", self.start_s), ("end", self.end_s))
        )
        if end < start:
            raise InvalidValueError(f"end of phone {self.symbol}", f"no time before its start, {start:g} s", end)
        object.__setattr__(self, "start_s", start)
        object.__setattr__(self, "end_s", end)

    @property
    def duration_s(self) -> float:
        """How long it lasts."""
        return self.end_s - self.start_s


def phones_of(rows: Iterable[Phone | Sequence[object]]) -> tuple[Phone, ...]:
    """Phones, or triples of symbol, start and end in s, one after the other; raises InvalidValueError."""
    phones = tuple(map(_phone_of, rows))
    for before, phone in pairwise(phones):
        if phone.start_s < before.end_s - OVERLAP_S:
            expected = f"no time before the last one's end, {before.end_s:g} s"
            raise InvalidValueError(f"start of phone {phone.symbol}", expected, phone.start_s)
    return phones


def _phone_of(row: Phone | Sequence[object]) -> Phone:
    if isinstance(row, Phone):
        return row
    if isinstance(row, str) or not isinstance(row, Sequence) or len(row) != 3:
        raise InvalidValueError("phone", "a symbol with its start and end in seconds", row)
    return Phone(*row)  # type: ignore[arg-type]  # checks what it takes
