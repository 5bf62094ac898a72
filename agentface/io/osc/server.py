"""A UDP socket before a :class:`Receiver`."""

from __future__ import annotations

import errno
import socket
import struct
import sys
import threading
from collections import deque
from collections.abc import Mapping
from types import TracebackType
from typing import Self

from agentface.clock import Clock, SystemClock
from agentface.errors import ServerError
from agentface.face import Face
from agentface.io.osc.codec import LARGEST_DATAGRAM
from agentface.io.osc.receiver import Receiver
from agentface.io.osc.schedule import Sender

DEFAULT_HOST, DEFAULT_PORT = "127.0.0.1", 7400
_LOOPBACK = ("127.0.0.1", "::1")
"""What ``localhost`` may mean; a program that sends to it takes one of them and hears of no other."""
_TRIES = 16
MOST_WAITING = 1024
"""So many datagrams may wait for the next frame; when more come, the oldest are dropped."""
_SOCKET_BUFFER = 4 * 1024 * 1024


class OscServer:
    """Receives OSC for faces from its making until ``close``; as a context manager, until the block ends.

    A source for :func:`agentface.live.loop.run`; a program with a loop of its own calls ``take_in`` before each
    ``face.step``. A thread for each socket does nothing but empty it; everything else happens in the loop's thread.

    Args:
        faces: what the messages are for: a face, which is also called by its own name, or at most eight by their ids.
        host: the address to listen on. The default takes messages from this machine alone, to ``127.0.0.1`` and,
            where the machine has it, ``::1``: ``localhost`` may mean either.
        port: 0 for any free one.
        clock: dates bundles and limits the rate of answers.

    ``addresses`` are what it understands; a program may add its own. Raises InvalidValueError for an id, and
    ServerError when the address of the machine cannot be had.
    """

    def __init__(
        self,
        faces: Face | Mapping[str, Face],
        host: str = DEFAULT_HOST,
        port: int = DEFAULT_PORT,
        *,
        clock: Clock | None = None,
    ) -> None:
        self._receiver = Receiver(faces, self._reply, clock or SystemClock())
        self._sockets = _bind(host, port)
        self.host, self.port = self._sockets[0].getsockname()[:2]
        self.addresses = self._receiver.addresses
        self._waiting: deque[tuple[bytes, Sender]] = deque(maxlen=MOST_WAITING)
        self._closed = threading.Event()
        self._threads = [
            threading.Thread(target=self._empty, args=(listener,), name="agentface-osc", daemon=True)
            for listener in self._sockets
        ]
        for thread in self._threads:
            thread.start()

    def take_in(self, time_s: float = 0.0) -> None:
        """Apply everything that came since the last call, whatever the time of the loop is."""
        waiting = [self._waiting.popleft() for _ in range(len(self._waiting))]
        self._receiver.take(waiting)

    def close(self) -> None:
        """Stop listening; may be called twice."""
        if self._closed.is_set():
            return
        self._closed.set()
        for thread, listener in zip(self._threads, self._sockets, strict=True):
            thread.join()
            listener.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _empty(self, listener: socket.socket) -> None:
        while not self._closed.is_set():
            try:
                # One byte more than allowed shows that a datagram is too long without taking all of it in.
                self._waiting.append(listener.recvfrom(LARGEST_DATAGRAM + 1))
            except BlockingIOError:
                continue
            except OSError:
                # For example the port of an earlier answer's receiver is closed; the next datagram may be well.
                self._closed.wait(0.001)

    def _reply(self, packet: bytes, sender: Sender) -> None:
        family = socket.AF_INET6 if len(sender) == 4 else socket.AF_INET  # IPv6 adds flow and scope to a place
        try:
            next(listener for listener in self._sockets if listener.family == family).sendto(packet, sender)
        except OSError:
            # The sender is gone or cannot be reached; it only misses its answer.
            return


def _bind(host: str, port: int, tries: int = _TRIES) -> list[socket.socket]:
    """The sockets that listen; both loopback addresses on one port where the loopback is meant."""
    if host.lower() not in ("localhost", _LOOPBACK[0]):
        return [_listen(host, port)]
    first = _loopback(_LOOPBACK[0], port)
    if first is None:
        return [_listen(_LOOPBACK[1], port)]
    try:
        second = _loopback(_LOOPBACK[1], first.getsockname()[1])
    except ServerError:
        first.close()
        if port or tries <= 1:
            raise
        return _bind(host, port, tries - 1)  # the port that the system chose is taken under the other address
    return [first] if second is None else [first, second]


def _loopback(host: str, port: int) -> socket.socket | None:
    """A socket on one of the loopback addresses; None where the machine does not have it."""
    try:
        return _listen(host, port)
    except ServerError as error:
        cause = error.__cause__
        if isinstance(cause, OSError) and cause.errno in (errno.EADDRNOTAVAIL, errno.EAFNOSUPPORT):
            return None
        raise


def _listen(host: str, port: int) -> socket.socket:
    try:
        family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise ServerError(f"OSC server: expected an address of this machine, got {host!r}: {error.strerror}") from error
    try:
        listener.bind(place)
    except OSError as error:
        listener.close()
        raise _refused(host, port, error) from error
    _enlarge(listener)
    # The system's own time limit costs one call a datagram, Python's costs two, and each gives the thread's turn away.
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, struct.pack("@ll", 0, 100_000))
    return listener


def _refused(host: str, port: int, error: OSError) -> ServerError:
    expected, advice = f"port {port} of {host} to be free", "end the program that has it, or choose another"
    if error.errno in (errno.EACCES, errno.EPERM):
        expected, advice = f"the right to listen on port {port} of {host}", "choose a port from 1024 on"
    elif error.errno == errno.EADDRNOTAVAIL:
        expected, advice = "an address of this machine", "choose one that it has"
    got = f"got {host!r}: " if error.errno == errno.EADDRNOTAVAIL else ""
    return ServerError(f"OSC server: expected {expected}, {got}{error.strerror}; {advice} with --osc HOST:PORT")


def _enlarge(listener: socket.socket) -> None:
    """As large a buffer as the system grants, for what arrives while a picture is drawn."""
    force = getattr(socket, "SO_RCVBUFFORCE", 33 if sys.platform == "linux" else socket.SO_RCVBUF)
    try:
        listener.setsockopt(socket.SOL_SOCKET, force, _SOCKET_BUFFER)
    except OSError:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _SOCKET_BUFFER)
