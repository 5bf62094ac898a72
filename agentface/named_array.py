""":class:`NamedArray`: numbers with names, which never change."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any, Self

import numpy.typing as npt


class NamedArray(Mapping[str, float]):
    """An immutable mapping from names to numbers over one read-only ``array``.

    Two of one class are equal when their arrays are, byte for byte; they hash, pickle and copy accordingly. With
    other mappings they compare as mappings do.
    """

    __slots__ = ("array",)
    array: npt.NDArray[Any]

    @abstractmethod
    def __init__(self, array: Any = None) -> None:
        """Take the numbers in the order of the names; every class checks its own."""

    def _freeze(self, array: npt.NDArray[Any]) -> None:
        """Keep ``array``, which nobody else may hold; a negative zero becomes a zero, so that equal is the same."""
        array += 0.0
        array.flags.writeable = False
        self.array = array

    def __eq__(self, other: object) -> bool:
        if other is self:
            return True
        if type(other) is type(self):
            return self.array.tobytes() == other.array.tobytes()
        return super().__eq__(other)

    def __hash__(self) -> int:
        return hash(self.array.tobytes())

    def __len__(self) -> int:
        return len(self.array)

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: object) -> Self:
        return self

    def __reduce__(self) -> tuple[type[Self], tuple[npt.NDArray[Any]]]:
        return type(self), (self.array,)
