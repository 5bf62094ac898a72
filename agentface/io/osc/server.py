"""A UDP socket before a :class:`Receiver`."""

from __future__ import annotations

from collections.abc import Mapping
from types import TracebackType
from typing import Self

from agentface.clock import Clock, SystemClock
from agentface.face import Face
from agentface.io.datagrams import Listener, Sender
from agentface.io.osc.codec import LARGEST_DATAGRAM
from agentface.io.osc.receiver import Receiver

DEFAULT_HOST, DEFAULT_PORT = "127.0.0.1", 7400


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
        self._listener = Listener(host, port, largest=LARGEST_DATAGRAM, what="OSC server", option="--osc")
        self.host, self.port = self._listener.host, self._listener.port
        self.addresses = self._receiver.addresses

    def take_in(self, time_s: float = 0.0) -> None:
        """Apply everything that came since the last call, whatever the time of the loop is."""
        self._receiver.take(self._listener.take())

    def close(self) -> None:
        """Stop listening; may be called twice."""
        self._listener.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _reply(self, packet: bytes, sender: Sender) -> None:
        self._listener.reply(packet, sender)
