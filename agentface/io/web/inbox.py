""":class:`Inbox`: what other threads want done in the thread in which faces are stepped."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any, TypeVar

from agentface.errors import ServerError

_T = TypeVar("_T")
MOST_WAITING = 1024
"""So many calls may wait for the next frame."""


class Inbox:
    """Calls that wait for the next frame; bounded, so that a flood is refused and not kept."""

    def __init__(self) -> None:
        self._calls: deque[tuple[Callable[[], Any], Future[Any]]] = deque()
        self._closed = False

    def ask(self, call: Callable[[], _T]) -> Future[_T]:
        """Have ``call`` called by :meth:`take_in`; the future has what it returns or raises.

        Raises ServerError when too many wait, and when nobody will take them in any more.
        """
        if self._closed:
            raise ServerError("web server: expected a face that runs, got one that has ended")
        if len(self._calls) >= MOST_WAITING:
            raise ServerError(f"web server: expected at most {MOST_WAITING} requests in a frame, got more; send fewer")
        future: Future[_T] = Future()
        self._calls.append((call, future))
        return future

    def take_in(self) -> None:
        """Call what waits, in its order."""
        for _ in range(len(self._calls)):
            call, future = self._calls.popleft()
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(call())
            except Exception as error:  # whoever asked is told, in their own thread
                future.set_exception(error)

    def close(self) -> None:
        """Nothing is taken in any more: who waits is told so."""
        self._closed = True
        while self._calls:
            self._calls.popleft()[1].cancel()
