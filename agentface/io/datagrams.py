"""UDP sockets that are emptied by threads of their own."""

from __future__ import annotations

import errno
import socket
import struct
import sys
import threading
from collections import deque
from typing import Any, TypeAlias

from agentface.errors import ServerError

Sender: TypeAlias = tuple[Any, ...]
"""The address of a socket."""
LOOPBACK = ("127.0.0.1", "::1")
"""What ``localhost`` may mean; a program that sends to it takes one of them and hears of no other."""
MOST_WAITING = 1024
"""So many datagrams may wait for the next frame; when more come, the oldest are dropped."""
_Who: TypeAlias = tuple[str, str]
"""Who listens, and the option that says where."""
_TRIES = 16
_SOCKET_BUFFER = 4 * 1024 * 1024


class Listener:
    """Receives datagrams from its making until ``close``. A thread for each socket does nothing but empty it.

    Args:
        host: the address to listen on; the IPv4 loopback or ``localhost`` means both loopback addresses.
        port: 0 for any free one.
        largest: bytes; of a longer datagram there is one byte more, which shows that it is too long.
        what: who listens, as errors call it.
        option: where a user says the address, for errors.

    Raises ServerError when the address of the machine cannot be had.
    """

    def __init__(self, host: str, port: int, *, largest: int, what: str, option: str) -> None:
        self._largest, self._who = largest, (what, option)
        self.sockets = _bind(host, port, self._who)
        self.host, self.port = self.sockets[0].getsockname()[:2]
        self.waiting: deque[tuple[bytes, Sender]] = deque(maxlen=MOST_WAITING)
        self._closed = threading.Event()
        self._threads = [
            threading.Thread(target=self._empty, args=(listener,), name="agentface-udp", daemon=True)
            for listener in self.sockets
        ]
        for thread in self._threads:
            thread.start()

    def take(self) -> list[tuple[bytes, Sender]]:
        """Everything that came since the last call, the oldest first."""
        return [self.waiting.popleft() for _ in range(len(self.waiting))]

    def reply(self, packet: bytes, sender: Sender) -> None:
        """Send something back."""
        family = socket.AF_INET6 if len(sender) == 4 else socket.AF_INET  # IPv6 adds flow and scope to a place
        try:
            next(listener for listener in self.sockets if listener.family == family).sendto(packet, sender)
        except OSError:
            # The sender is gone or cannot be reached; it only misses its answer.
            return

    def close(self) -> None:
        """Stop listening; may be called twice."""
        if self._closed.is_set():
            return
        self._closed.set()
        for thread, listener in zip(self._threads, self.sockets, strict=True):
            thread.join()
            listener.close()

    def _empty(self, listener: socket.socket) -> None:
        while not self._closed.is_set():
            try:
                self.waiting.append(listener.recvfrom(self._largest + 1))
            except BlockingIOError:
                continue
            except OSError:
                # For example the port of an earlier answer's receiver is closed; the next datagram may be well.
                self._closed.wait(0.001)


def _bind(host: str, port: int, who: _Who, tries: int = _TRIES) -> list[socket.socket]:
    """The sockets that listen; both loopback addresses on one port where the loopback is meant."""
    if host.lower() not in ("localhost", LOOPBACK[0]):
        return [_listen(host, port, who)]
    first = _loopback(LOOPBACK[0], port, who)
    if first is None:
        return [_listen(LOOPBACK[1], port, who)]
    try:
        second = _loopback(LOOPBACK[1], first.getsockname()[1], who)
    except ServerError:
        first.close()
        if port or tries <= 1:
            raise
        return _bind(host, port, who, tries - 1)  # the port that the system chose is taken under the other address
    return [first] if second is None else [first, second]


def _loopback(host: str, port: int, who: _Who) -> socket.socket | None:
    """A socket on one of the loopback addresses; None where the machine does not have it."""
    try:
        return _listen(host, port, who)
    except ServerError as error:
        cause = error.__cause__
        if isinstance(cause, OSError) and cause.errno in (errno.EADDRNOTAVAIL, errno.EAFNOSUPPORT):
            return None
        raise


def _listen(host: str, port: int, who: _Who) -> socket.socket:
    try:
        family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise ServerError(f"{who[0]}: expected an address of this machine, got {host!r}: {error.strerror}") from error
    try:
        listener.bind(place)
    except OSError as error:
        listener.close()
        raise _refused(host, port, error, who) from error
    _enlarge(listener)
    # The system's own time limit costs one call a datagram, Python's costs two, and each gives the thread's turn away.
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, struct.pack("@ll", 0, 100_000))
    return listener


def _refused(host: str, port: int, error: OSError, who: _Who) -> ServerError:
    expected, advice = f"port {port} of {host} to be free", "end the program that has it, or choose another"
    if error.errno in (errno.EACCES, errno.EPERM):
        expected, advice = f"the right to listen on port {port} of {host}", "choose a port from 1024 on"
    elif error.errno == errno.EADDRNOTAVAIL:
        expected, advice = "an address of this machine", "choose one that it has"
    got = f"got {host!r}: " if error.errno == errno.EADDRNOTAVAIL else ""
    return ServerError(f"{who[0]}: expected {expected}, {got}{error.strerror}; {advice} with {who[1]} HOST:PORT")


def _enlarge(listener: socket.socket) -> None:
    """As large a buffer as the system grants, for what arrives while a picture is drawn."""
    force = getattr(socket, "SO_RCVBUFFORCE", 33 if sys.platform == "linux" else socket.SO_RCVBUF)
    try:
        listener.setsockopt(socket.SOL_SOCKET, force, _SOCKET_BUFFER)
    except OSError:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _SOCKET_BUFFER)
