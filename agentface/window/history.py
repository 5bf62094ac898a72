"""What was changed, to be taken back and done again."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

Values = Mapping[str, float | None]
"""What a change sets, by name; None releases a muscle."""

LEVELS = 200


@dataclass(frozen=True, slots=True)
class Edit:
    """The values of the same names before and after."""

    before: Values
    after: Values


class History:
    """Changes in the order they were made, at most ``LEVELS`` of them.

    Changes of one ``gesture``, such as a slider that is dragged, are one change until ``settle``.
    """

    def __init__(self) -> None:
        self._done: list[Edit] = []
        self._undone: list[Edit] = []
        self._gesture: str | None = None

    @property
    def can_undo(self) -> bool:
        """Whether there is a change to take back."""
        return bool(self._done)

    @property
    def can_redo(self) -> bool:
        """Whether there is a change to do again."""
        return bool(self._undone)

    def note(self, before: Values, after: Values, gesture: str | None = None) -> None:
        """Remember a change; what was undone before it can no longer be done again."""
        self._undone.clear()
        if gesture is not None and gesture == self._gesture:
            last = self._done.pop()
            before, after = {**before, **last.before}, {**last.after, **after}
        else:
            self.settle()
        self._gesture = gesture
        self._done.append(Edit(before, after))
        del self._done[:-LEVELS]

    def settle(self) -> None:
        """End the gesture; one that ended where it began is forgotten."""
        if self._gesture is not None and self._done[-1].before == self._done[-1].after:
            self._done.pop()
        self._gesture = None

    def undo(self) -> Values:
        """The values that take the last change back; none when there is nothing to take back."""
        self.settle()
        if not self._done:
            return {}
        self._undone.append(self._done.pop())
        return self._undone[-1].before

    def redo(self) -> Values:
        """The values that make the last undone change again; none when there is none."""
        self.settle()
        if not self._undone:
            return {}
        self._done.append(self._undone.pop())
        return self._done[-1].after
