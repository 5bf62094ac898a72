"""Clocks that tests move."""

from __future__ import annotations

import socket
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import pytest

from tests.waiting import until

if TYPE_CHECKING:
    from agentface.io.osc.server import OscServer


class ManualClock:
    """A clock that moves only when it is told to; waiting moves it."""

    def __init__(self, start: float = 0.0, date: float = 1_000_000_000.0) -> None:
        self._now, self._offset = start, date - start

    def now(self) -> float:
        """The seconds it was moved, plus ``start``."""
        return self._now

    def date(self) -> float:
        """The date it was given at the start, plus the seconds it was moved."""
        return self._now + self._offset

    def sleep(self, seconds: float) -> None:
        """Move the clock on."""
        self._now += max(0.0, seconds)


class ServedClock(ManualClock):
    """The clock of ``agentface serve`` in a test: ``meanwhile(server)`` is called whenever the loop waits.

    So what another program sends comes at its time, and every run is the same.
    """

    def __init__(self, meanwhile: Callable[[OscServer], object] = lambda _: None) -> None:
        super().__init__()
        self._meanwhile = meanwhile
        self._server: OscServer | None = None

    def sleep(self, seconds: float) -> None:
        """Move the clock on."""
        super().sleep(seconds)
        assert self._server is not None
        self._meanwhile(self._server)

    @contextmanager
    def at_work(self) -> Iterator[None]:
        """In place of the machine's clock in the loop of a command, though not in the server or at the loudspeaker."""
        from agentface.io import voice_output  # noqa: F401 - has its clock from before
        from agentface.io.osc.server import OscServer

        opened = OscServer.__init__

        def noted(server: OscServer, *arguments: Any, **options: Any) -> None:
            opened(server, *arguments, **options)
            self._server = server

        with pytest.MonkeyPatch.context() as patched:
            patched.setattr(OscServer, "__init__", noted)
            patched.setattr("agentface.clock.SystemClock", lambda: self)
            yield


def send(server: OscServer, packet: bytes) -> None:
    """Send a datagram to a server that waits, and come back when it is there."""
    before = len(server._listener.waiting)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.sendto(packet, (server.host, server.port))
    until(lambda: len(server._listener.waiting) > before)
