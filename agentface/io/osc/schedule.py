"""Commands of bundles that are to be played later, in their order."""

from __future__ import annotations

import heapq
from itertools import count

from agentface.io.osc.commands import Command

FURTHEST_S = 600.0
"""A bundle may lie at most so many seconds ahead."""
MOST = 4096
"""So many commands may wait."""


class Agenda:
    """A bounded heap of commands by their date."""

    def __init__(self) -> None:
        self._heap: list[tuple[float, int, Command]] = []
        self._order = count()

    def __len__(self) -> int:
        return len(self._heap)

    @property
    def full(self) -> bool:
        """Whether nothing more fits."""
        return len(self._heap) >= MOST

    def add(self, date: float, command: Command) -> None:
        """Keep a command until ``date``, seconds since 1970."""
        heapq.heappush(self._heap, (date, next(self._order), command))

    def due(self, date: float) -> list[Command]:
        """Take out everything whose time has come, the earliest first."""
        commands = []
        while self._heap and self._heap[0][0] <= date:
            commands.append(heapq.heappop(self._heap)[2])
        return commands
