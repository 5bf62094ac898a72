""":class:`Hub`: the pages that look on, each with its newest frame. Everything here belongs to one event loop."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Awaitable, Callable, Mapping

from agentface.clock import Clock
from agentface.io.web.frames import Mode

MOST_CLIENTS = 64
_MOST_BYTES = 4 * 1024 * 1024
"""Of sound and words that a client may leave waiting."""
_AHEAD = 24
"""Frames that a client which confirms them gets before it has confirmed them: what is under way is never old."""
_LOST = 512
Message = bytes | str


class Client:
    """One page.

    Args:
        send: hands a message over, and waits until there is room for another.
        face: the id of the face that it shows.
        mode: how it wants its frames.
        clock: measures how long frames are under way.

    Attributes:
        dropped: frames that were replaced by newer ones.
        latency_s: from the writing of the last confirmed frame until its confirmation; None before.
    """

    def __init__(self, send: Callable[[Message], Awaitable[None]], face: str, mode: Mode, clock: Clock) -> None:
        self.face, self.mode = face, mode
        self.dropped = self.sent = 0
        self.latency_s: float | None = None
        self.failed = False
        self._send, self._clock = send, clock
        self._frame: tuple[int, bytes] | None = None
        self._words: deque[Message] = deque()
        self._waiting_bytes = 0
        self._under_way: deque[tuple[int, float]] = deque(maxlen=_LOST)
        self._confirms = False
        self._awake = asyncio.Event()

    def show(self, frame: int, message: bytes) -> None:
        """Have the newest frame, in place of one that was not sent yet."""
        self.dropped += self._frame is not None
        self._frame = frame, message
        self._awake.set()

    def tell(self, message: Message) -> None:
        """Have a message that no other replaces; who leaves too many lying fails."""
        self._waiting_bytes += len(message)
        if self._waiting_bytes > _MOST_BYTES:
            self.failed = True
        else:
            self._words.append(message)
        self._awake.set()

    def confirm(self, frame: int) -> None:
        """A frame was drawn, and so were those before it."""
        self._confirms = True
        if not any(number == frame for number, _ in self._under_way):
            return
        while self._under_way:
            number, written_s = self._under_way.popleft()
            if number == frame:
                self.latency_s = self._clock.now() - written_s
                break
        self._awake.set()

    async def run(self) -> None:
        """Send what there is, until the client fails."""
        while not self.failed:
            await self._awake.wait()
            self._awake.clear()
            while self._words and not self.failed:
                message = self._words.popleft()
                self._waiting_bytes -= len(message)
                await self._send(message)
            if self._frame is not None and not (self._confirms and len(self._under_way) >= _AHEAD):
                (frame, record), self._frame = self._frame, None
                self._under_way.append((frame, self._clock.now()))
                self.sent += 1
                await self._send(record)


class Hub:
    """All pages.

    Attributes:
        clients: those that look on.
        wanted: in which modes each face's frames are looked at; replaced, never changed, so that any thread may read.
    """

    def __init__(self) -> None:
        self.clients: set[Client] = set()
        self.wanted: Mapping[str, frozenset[Mode]] = {}

    @property
    def full(self) -> bool:
        """Whether no more are taken."""
        return len(self.clients) >= MOST_CLIENTS

    def join(self, client: Client) -> None:
        """Look on."""
        self.clients.add(client)
        self._count()

    def leave(self, client: Client) -> None:
        """Look away."""
        self.clients.discard(client)
        self._count()

    def show(self, face: str, mode: Mode, frame: int, message: bytes) -> None:
        """Give a frame to those who look at it."""
        for client in self.clients:
            if client.face == face and client.mode == mode:
                client.show(frame, message)

    def tell(self, face: str, message: Message) -> None:
        """Give a message to those who look at a face."""
        for client in self.clients:
            if client.face == face:
                client.tell(message)

    def _count(self) -> None:
        faces = {client.face for client in self.clients}
        self.wanted = {face: frozenset(client.mode for client in self.clients if client.face == face) for face in faces}
