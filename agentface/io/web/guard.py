""":func:`guarded`: a web server that answers only those who may ask, and no more than it can bear.

Any page that a user visits can send requests to this machine, the loopback included, and can have its own name resolve
to it (DNS rebinding): so ``Host`` and ``Origin`` are checked in every request. Source: RFC 6454 (origins), RFC 6750
(bearer tokens), W3C Fetch (CORS).
"""

from __future__ import annotations

import json
from collections import OrderedDict
from collections.abc import Awaitable, Callable, Collection, MutableMapping
from dataclasses import dataclass
from typing import Any, TypeAlias
from urllib.parse import parse_qsl

from agentface.clock import Clock, SystemClock
from agentface.io.osc.rate_limit import RateLimit
from agentface.io.web.access import Access

Scope: TypeAlias = MutableMapping[str, Any]
Message: TypeAlias = MutableMapping[str, Any]
Receive: TypeAlias = Callable[[], Awaitable[Message]]
Send: TypeAlias = Callable[[Message], Awaitable[None]]
App: TypeAlias = Callable[[Scope, Receive, Send], Awaitable[None]]

LARGEST_BODY = 256 * 1024
"""Bytes of one request."""
REQUESTS_AT_ONCE, REQUESTS_A_SECOND = 240.0, 120.0
"""Of one address."""
_LONGEST_QUERY = 2048
_MOST_ADDRESSES = 1024
_HEADERS = ("authorization", "content-type", "last-event-id", "mcp-protocol-version", "mcp-session-id")
_READING = ("GET", "HEAD", "OPTIONS")


@dataclass(frozen=True, slots=True)
class Refusal:
    """Why a request is not answered; ``status`` is HTTP's."""

    status: int
    where: str
    expected: str
    got: str
    hint: str = ""

    def body(self) -> bytes:
        """As JSON, in the form of all errors."""
        told = {"where": self.where, "expected": self.expected, "got": self.got, "hint": self.hint}
        return json.dumps({"error": told}).encode()


class Guard:
    """An ASGI application before another, which gets only what ``access`` allows.

    Args:
        app: what is guarded.
        access: who may ask.
        open_paths: what needs no token: a page and its program, which are no secret.
        largest_body: bytes of one request.
        clock: limits the rate of each address.
    """

    def __init__(
        self,
        app: App,
        access: Access,
        *,
        open_paths: Collection[str] = (),
        largest_body: int = LARGEST_BODY,
        clock: Clock | None = None,
    ) -> None:
        self._app, self._access, self._open = app, access, frozenset(open_paths)
        self._largest, self._clock = largest_body, clock or SystemClock()
        self._rates: OrderedDict[str, RateLimit] = OrderedDict()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        refusal = self.refusal(scope)
        if refusal is not None:
            await _refuse(scope, receive, send, refusal)
        elif scope["type"] == "http":
            await self._bounded(scope, receive, send)
        else:
            await self._app(scope, receive, send)

    def refusal(self, scope: Scope) -> Refusal | None:
        """Why a request is not answered; None where it is."""
        headers = _Headers(scope)
        host, origin = headers.only("host"), headers.only("origin")
        if host is None or not self._access.knows_host(host):
            got = "none, or several" if host is None else _cut(host)
            return Refusal(403, "Host", "the name or address of this server", got, "ask for it by its own address")
        if origin is None and headers.count("origin"):
            return Refusal(403, "Origin", "one", "several")
        if origin is not None and not self._access.knows_origin(origin, host):
            hint = "start the server with --allow-origin and the URL of the site whose pages may ask"
            return Refusal(403, "Origin", "a page of this server, or of a site that it allows", _cut(origin), hint)
        if origin is None and _changes(scope) and headers.only("sec-fetch-site") == "cross-site":
            return Refusal(403, "Sec-Fetch-Site", "a request of a page of this server", "cross-site")
        if not self._rate(scope).take():
            return Refusal(429, "rate", f"at most {REQUESTS_A_SECOND:g} requests a second", "more", "wait a second")
        if len(scope.get("query_string", b"")) > _LONGEST_QUERY:
            return Refusal(414, "query", f"at most {_LONGEST_QUERY} bytes", "more")
        if (
            scope["path"] not in self._open
            and scope.get("method") != "OPTIONS"
            and not self._shows_token(scope, headers)
        ):
            hint = "send the header Authorization: Bearer TOKEN, or ?token=TOKEN, as the server told when it started"
            return Refusal(401, "token", "the token of this server", "none, or another", hint)
        return None

    def _shows_token(self, scope: Scope, headers: _Headers) -> bool:
        kind, _, shown = (headers.only("authorization") or "").partition(" ")
        if kind.lower() == "bearer" and self._access.knows_token(shown.strip()):
            return True
        query = dict(parse_qsl(scope.get("query_string", b"").decode("ascii", "replace"), max_num_fields=32))
        return self._access.knows_token(query.get("token"))

    def _rate(self, scope: Scope) -> RateLimit:
        address = str((scope.get("client") or ("",))[0])
        rate = self._rates.pop(address, None) or RateLimit(self._clock, REQUESTS_AT_ONCE, REQUESTS_A_SECOND)
        self._rates[address] = rate
        while len(self._rates) > _MOST_ADDRESSES:
            self._rates.popitem(last=False)
        return rate

    async def _bounded(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on a request whose body is not too large, as far as it says, and as far as it comes."""
        refusal = Refusal(413, "body", f"at most {self._largest} bytes", "more", "send less at once")
        length = _Headers(scope).only("content-length") or "0"
        if not length.isdecimal() or int(length) > self._largest:
            await _refuse(scope, receive, send, refusal)
            return
        came, begun = 0, False

        async def counted() -> Message:
            nonlocal came
            message = await receive()
            came += len(message.get("body", b""))
            if came > self._largest:
                raise _TooLargeError
            return message

        async def noted(message: Message) -> None:
            nonlocal begun
            begun = True
            await send(message)

        try:
            await self._app(scope, counted, noted)
        except _TooLargeError:
            if not begun:
                await _refuse(scope, receive, send, refusal)


class _TooLargeError(Exception):
    """More has come than is taken."""


class _Headers:
    """The headers of a request by their name in lower case."""

    def __init__(self, scope: Scope) -> None:
        self._rows = [(name.decode("latin-1").lower(), value.decode("latin-1")) for name, value in scope["headers"]]

    def count(self, name: str) -> int:
        return sum(known == name for known, _ in self._rows)

    def only(self, name: str) -> str | None:
        """The value of a header that is there once; None otherwise."""
        values = [value for known, value in self._rows if known == name]
        return values[0] if len(values) == 1 else None


def guarded(
    app: App,
    access: Access,
    *,
    open_paths: Collection[str] = (),
    largest_body: int = LARGEST_BODY,
    clock: Clock | None = None,
) -> App:
    """``app`` behind a :class:`Guard`, and with what lets browsers read the answers to the pages of allowed sites.

    Needs starlette: the extra ``web``, or ``mcp``.
    """
    from starlette.middleware.cors import CORSMiddleware

    shared = CORSMiddleware(
        app,
        allow_origins=sorted(access.origins),
        allow_methods=["GET", "POST", "DELETE"],
        allow_headers=_HEADERS,
        allow_private_network=True,
        expose_headers=["mcp-session-id"],
    )
    return Guard(
        shared,
        access,
        open_paths=open_paths,
        largest_body=largest_body,
        clock=clock,
    )


def _changes(scope: Scope) -> bool:
    """Whether a request may change something."""
    return scope["type"] == "websocket" or scope.get("method") not in _READING


def _cut(text: str) -> str:
    return text if len(text) <= 80 else f"{text[:77]}..."


async def _refuse(scope: Scope, receive: Receive, send: Send, refusal: Refusal) -> None:
    kind = "http"
    if scope["type"] == "websocket":
        await receive()  # the request to connect
        if "websocket.http.response" not in scope.get("extensions", {}):
            await send({"type": "websocket.close", "code": 1008})
            return
        kind = "websocket.http"
    headers = [(b"content-type", b"application/json"), (b"cache-control", b"no-store"), (b"connection", b"close")]
    if refusal.status == 401:
        headers.append((b"www-authenticate", b"Bearer"))
    await send({"type": f"{kind}.response.start", "status": refusal.status, "headers": headers})
    await send({"type": f"{kind}.response.body", "body": refusal.body()})
