""":func:`serve_http`: the tools over HTTP, for programs that reach a server by its address."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, cast

from agentface.io.web.access import Access
from agentface.io.web.guard import App, guarded
from agentface.io.web.serving import Serving, listen

if TYPE_CHECKING:
    from mcp.server.mcpserver import MCPServer

PATH = "/mcp"
_MOST_SESSIONS, _IDLE_S = 64, 1800.0


class HttpAddress(Serving):
    """Where the tools are served.

    Attributes:
        access: who may ask.
        url: what a client is given.
    """

    def __init__(self, app: App, access: Access, host: str, port: int) -> None:
        super().__init__(app, listen(host, port, "MCP server", "--http"), ws="none", lifespan="on")
        self.access = access

    @property
    def url(self) -> str:
        """Where clients find it."""
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"http://{host}:{self.port}{PATH}"


def serve_http(
    server: MCPServer[Any], host: str, port: int, *, token: str | None = None, origins: Sequence[str] = ()
) -> HttpAddress:
    """Serve from now on until the end of a ``with`` block, guarded as web pages are.

    Every address but the loopback's has a token, which is made where none is given; a page of another site is let in
    only by ``origins``. Raises ServerError for an address that cannot be had, InvalidValueError.
    """
    from mcp.server.transport_security import TransportSecuritySettings

    access = Access.of(host, origins, token)
    # the guard is what checks Host and Origin
    lax = TransportSecuritySettings(enable_dns_rebinding_protection=False)
    app = server.streamable_http_app(
        streamable_http_path=PATH,
        transport_security=lax,
        max_sessions=_MOST_SESSIONS,
        session_idle_timeout=_IDLE_S,
    )
    return HttpAddress(guarded(cast("App", app), access), access, host, port)
