"""Requests of bundles that are to be played later, in their order."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from itertools import count

from agentface.io.datagrams import Sender
from agentface.requests import Request

FURTHEST_S = 600.0
"""A bundle may lie at most so many seconds ahead."""
MOST = 4096
"""So many requests may wait."""


@dataclass(frozen=True, slots=True)
class Waiting:
    """A request and where it came from: whom to answer should the face refuse it."""

    request: Request
    sender: Sender
    address: str


class Schedule:
    """A bounded heap of requests by their date."""

    def __init__(self) -> None:
        self._heap: list[tuple[float, int, Waiting]] = []
        self._order = count()

    def __len__(self) -> int:
        return len(self._heap)

    @property
    def full(self) -> bool:
        """Whether nothing more fits."""
        return len(self._heap) >= MOST

    def add(self, date: float, waiting: Waiting) -> None:
        """Keep a request until ``date``, seconds since 1970."""
        heapq.heappush(self._heap, (date, next(self._order), waiting))

    def due(self, date: float) -> list[Waiting]:
        """Take out everything whose time has come, the earliest first."""
        requests = []
        while self._heap and self._heap[0][0] <= date:
            requests.append(heapq.heappop(self._heap)[2])
        return requests
