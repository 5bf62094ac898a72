"""A UDP socket before a :class:`Receiver`."""

from __future__ import annotations

import socket
import struct
import sys
import threading
from collections import deque
from types import TracebackType
from typing import Self

from agentface.clock import Clock, SystemClock
from agentface.errors import ServerError
from agentface.face import Face
from agentface.io.osc.codec import LARGEST_DATAGRAM
from agentface.io.osc.receiver import Receiver
from agentface.io.osc.schedule import Sender

DEFAULT_HOST, DEFAULT_PORT = "127.0.0.1", 7400
MOST_WAITING = 1024
"""So many datagrams may wait for the next frame; when more come, the oldest are dropped."""
_SOCKET_BUFFER = 4 * 1024 * 1024


class OscServer:
    """Receives OSC for a face from its making until ``close``; as a context manager, until the block ends.

    A thread does nothing but empty the socket; everything else happens in ``Face.step``, in the thread that
    calls it.

    Args:
        face: what the messages are for.
        host: the address to listen on; the default takes messages from this machine alone.
        port: 0 for any free one.
        clock: dates bundles and limits the rate of answers.

    ``addresses`` are what it understands; a program may add its own. Raises ServerError when the address of the
    machine cannot be had.
    """

    def __init__(
        self, face: Face, host: str = DEFAULT_HOST, port: int = DEFAULT_PORT, *, clock: Clock | None = None
    ) -> None:
        self._socket = _bind(host, port)
        self.host, self.port = self._socket.getsockname()[:2]
        self._face = face
        self._receiver = Receiver(face, self._reply, clock or SystemClock())
        self.addresses = self._receiver.addresses
        self._waiting: deque[tuple[bytes, Sender]] = deque(maxlen=MOST_WAITING)
        self._closed = threading.Event()
        self._thread = threading.Thread(target=self._empty_socket, name="agentface-osc", daemon=True)
        self._thread.start()
        face.inputs.append(self.take_in)

    def take_in(self) -> None:
        """Apply everything that came since the last call; ``Face.step`` does this."""
        waiting = [self._waiting.popleft() for _ in range(len(self._waiting))]
        self._receiver.take(waiting)

    def close(self) -> None:
        """Stop listening; may be called twice."""
        if self._closed.is_set():
            return
        self._closed.set()
        self._face.inputs.remove(self.take_in)
        self._thread.join()
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _empty_socket(self) -> None:
        while not self._closed.is_set():
            try:
                # One byte more than allowed shows that a datagram is too long without taking all of it in.
                self._waiting.append(self._socket.recvfrom(LARGEST_DATAGRAM + 1))
            except BlockingIOError:
                continue
            except OSError:
                # For example the port of an earlier answer's receiver is closed; the next datagram may be well.
                self._closed.wait(0.001)

    def _reply(self, packet: bytes, sender: Sender) -> None:
        try:
            self._socket.sendto(packet, sender)
        except OSError:
            # The sender is gone or cannot be reached; it only misses its answer.
            return


def _bind(host: str, port: int) -> socket.socket:
    try:
        family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_DGRAM)[0]
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise ServerError(f"OSC server: expected an address of this machine, got {host!r}: {error.strerror}") from error
    try:
        listener.bind(place)
    except OSError as error:
        listener.close()
        advice = "end the program that has it, or choose another with --osc HOST:PORT"
        raise ServerError(
            f"OSC server: expected port {port} of {host} to be free: {error.strerror}; {advice}"
        ) from error
    _enlarge(listener)
    # The system's own time limit costs one call a datagram, Python's costs two, and each gives the thread's turn away.
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVTIMEO, struct.pack("@ll", 0, 100_000))
    return listener


def _enlarge(listener: socket.socket) -> None:
    """As large a buffer as the system grants, for what arrives while a picture is drawn."""
    force = getattr(socket, "SO_RCVBUFFORCE", 33 if sys.platform == "linux" else socket.SO_RCVBUF)
    try:
        listener.setsockopt(socket.SOL_SOCKET, force, _SOCKET_BUFFER)
    except OSError:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, _SOCKET_BUFFER)
