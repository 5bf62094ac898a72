""":class:`Access`: who may reach a server on an address of this machine."""

from __future__ import annotations

import re
import secrets
import socket
from collections.abc import Sequence
from dataclasses import dataclass
from ipaddress import IPv4Address, IPv6Address, ip_address
from urllib.parse import urlsplit

from agentface.errors import InvalidValueError

_TOKEN_BYTES = 24
_SHORTEST_TOKEN, _LONGEST_TOKEN = 12, 256
_PORTS = {"http": 80, "https": 443}
_LOOPBACK_NAME = "localhost"


@dataclass(frozen=True, slots=True)
class Access:
    """Who may reach a server that listens on ``host``.

    Attributes:
        host: the address that it listens on.
        token: what every request has to show; None for none.
        origins: the web sites whose pages may reach it beside its own, as ``https://example.org``.
        names: what this machine is called, beside its addresses.
    """

    host: str
    token: str | None = None
    origins: frozenset[str] = frozenset()
    names: frozenset[str] = frozenset()

    @classmethod
    def of(cls, host: str, origins: Sequence[str] = (), token: str | None = None) -> Access:
        """For ``host``; every address but the loopback's has a token, a new one where none is given.

        Raises InvalidValueError for a token that is easily guessed, and for what is no origin.
        """
        if token is not None and not re.fullmatch(rf"[\x21-\x7e]{{{_SHORTEST_TOKEN},{_LONGEST_TOKEN}}}", token):
            expected = f"{_SHORTEST_TOKEN} to {_LONGEST_TOKEN} characters of ASCII without blanks"
            raise InvalidValueError("token", expected, "another", "leave it out: a good one is then made")
        if token is None and not is_loopback(host):
            token = secrets.token_urlsafe(_TOKEN_BYTES)
        machine = socket.gethostname().lower()
        return cls(
            host.lower(),
            token,
            frozenset(check_origin(origin) for origin in origins),
            frozenset({machine, f"{machine}.local"}),
        )

    @property
    def loopback(self) -> bool:
        """Whether programs on this machine alone reach it."""
        return is_loopback(self.host)

    def knows_host(self, authority: str) -> bool:
        """Whether a request whose ``Host`` is this is meant for this server.

        Others are the work of a page whose name was made to resolve to this machine (DNS rebinding).
        """
        parts = split_authority(authority)
        if parts is None:
            return False
        name = parts[0]
        if is_loopback(name) or name == self.host:
            return True
        if any(urlsplit(origin).hostname == name for origin in self.origins):
            return True
        return not self.loopback and (name in self.names or _address(name) is not None)

    def knows_origin(self, origin: str, authority: str) -> bool:
        """Whether a page of ``origin`` may send a request to ``authority``: one of its own, or of ``origins``."""
        try:
            asked = check_origin(origin)
        except InvalidValueError:
            return False
        scheme, _, rest = asked.partition("://")
        own, host = split_authority(rest), split_authority(authority)
        if asked in self.origins:
            return True
        return own is not None and host is not None and _with_port(own, scheme) == _with_port(host, scheme)

    def knows_token(self, shown: str | None) -> bool:
        """Whether this is the token; compared in a time that says nothing about it."""
        if self.token is None:
            return True
        return shown is not None and secrets.compare_digest(shown.encode("utf-8", "replace"), self.token.encode())

    def told(self, what: str) -> list[str]:
        """What is open to whom, in lines for whoever starts ``what``."""
        who = "programs on this machine" if self.loopback else "every machine that reaches it"
        needs = f" with the token {self.token}" if self.token is not None else ""
        pages = "pages that it serves itself"
        if self.origins:
            pages = f"{pages} and those of {', '.join(sorted(self.origins))}"
        return [f"{what} is open to {who}{needs}, and in browsers to {pages}"]


def is_loopback(host: str) -> bool:
    """Whether an address or name is this machine's loopback."""
    name = host.lower().strip("[]")
    if name == _LOOPBACK_NAME or name.endswith(f".{_LOOPBACK_NAME}"):
        return True
    address = _address(name)
    mapped = getattr(address, "ipv4_mapped", None)
    return (mapped or address).is_loopback if address is not None else False


def check_origin(origin: str) -> str:
    """An origin in its usual spelling, ``https://example.org``; raises InvalidValueError for anything else."""
    expected = "a web site such as https://example.org or http://localhost:3000"
    if not isinstance(origin, str) or not origin.isascii() or len(origin) > 300:
        raise InvalidValueError("origin", expected, origin)
    match = re.fullmatch(r"(https?)://([^/?#@\s]+)/?", origin, re.IGNORECASE)
    parts = split_authority(match[2]) if match else None
    if match is None or parts is None:
        raise InvalidValueError("origin", expected, origin, "give scheme, name and port alone, and no *")
    scheme, (name, port) = match[1].lower(), parts
    name = f"[{name}]" if ":" in name else name
    return f"{scheme}://{name}" if port in (None, _PORTS[scheme]) else f"{scheme}://{name}:{port}"


def split_authority(authority: str) -> tuple[str, int | None] | None:
    """Name or address, in lower case and without brackets, and port, of ``HOST[:PORT]``; None for anything else."""
    match = re.fullmatch(r"(\[[0-9a-fA-F:.]+\]|[A-Za-z0-9._-]+)(?::(\d{1,5}))?", authority)
    if match is None or (match[2] and int(match[2]) > 65535):
        return None
    return match[1].strip("[]").lower().rstrip("."), int(match[2]) if match[2] else None


def _with_port(parts: tuple[str, int | None], scheme: str) -> tuple[str, int]:
    return parts[0], parts[1] or _PORTS[scheme]


def _address(name: str) -> IPv4Address | IPv6Address | None:
    try:
        return ip_address(name)
    except ValueError:
        return None
