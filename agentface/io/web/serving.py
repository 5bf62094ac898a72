""":class:`Serving`: an ASGI application on an address, in a thread of its own."""

from __future__ import annotations

import asyncio
import errno
import socket
import threading
from types import TracebackType
from typing import Any, Self

from agentface.errors import ServerError
from agentface.io.web.guard import App


class Serving:
    """Serves ``app``, which is guarded, from its making until ``close``; as a context manager, until the block ends.

    Args:
        app: what answers.
        listener: of :func:`listen`; closed in the end.
        options: what uvicorn is told beside what keeps a server small and quiet.

    Attributes:
        loop: the event loop in which it answers; None until it does.

    Raises ImportError without uvicorn.
    """

    def __init__(self, app: App, listener: socket.socket, **options: Any) -> None:
        import uvicorn

        self.host, self.port = listener.getsockname()[:2]
        self._socket = listener
        self.loop: asyncio.AbstractEventLoop | None = None
        config = uvicorn.Config(
            app,
            log_config=None,
            access_log=False,
            interface="asgi3",
            http="h11",
            limit_concurrency=256,
            timeout_keep_alive=10,
            timeout_graceful_shutdown=1,
            h11_max_incomplete_event_size=16 * 1024,
            proxy_headers=False,
            server_header=False,
            **options,
        )
        self._server = uvicorn.Server(config)
        self._thread = threading.Thread(target=self._serve, name="agentface-http", daemon=True)
        self._thread.start()

    @property
    def running(self) -> bool:
        """Whether it answers."""
        return self._thread.is_alive()

    def close(self) -> None:
        """Stop serving; may be called twice."""
        self._server.should_exit = True
        self._thread.join()
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _serve(self) -> None:
        async def serve() -> None:
            self.loop = asyncio.get_running_loop()
            await self._server.serve(sockets=[self._socket])

        asyncio.run(serve())


def listen(host: str, port: int, what: str, option: str) -> socket.socket:
    """A socket that listens; ``what`` and ``option`` are how errors call the server and what chooses its address.

    Raises ServerError.
    """
    try:
        family, kind, protocol, _, place = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)[0]
        listener = socket.socket(family, kind, protocol)
    except OSError as error:
        raise ServerError(f"{what}: expected an address of this machine, got {host!r}: {error.strerror}") from error
    try:
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listener.bind(place)
        listener.listen(128)
    except OSError as error:
        listener.close()
        expected = f"port {port} of {host} to be free"
        if error.errno in (errno.EACCES, errno.EPERM):
            expected = f"the right to listen on port {port} of {host}"
        elif error.errno == errno.EADDRNOTAVAIL:
            expected = f"an address of this machine, not {host}"
        advice = f"choose another with {option} HOST:PORT"
        raise ServerError(f"{what}: expected {expected}, got {error.strerror}; {advice}") from error
    listener.setblocking(False)
    return listener
