""":func:`serve_stdio`: a server that talks over the standard streams, as programs start it."""

from __future__ import annotations

import os
import sys
from collections.abc import AsyncIterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from mcp.server.mcpserver import MCPServer

LONGEST_LINE = 1 << 20
"""Bytes of one message."""
_CHUNK = 1 << 16


async def serve_stdio(server: MCPServer[Any]) -> None:
    """Serve until the standard input ends, or until it is cancelled.

    The standard output belongs to the protocol: what else is written to it, here or by a child, goes to the standard
    error, and children find no input.
    """
    from mcp.server.stdio import stdio_server

    wire = os.dup(0)
    nothing = os.open(os.devnull, os.O_RDONLY)
    os.dup2(nothing, 0)
    os.close(nothing)
    sys.stdout.flush()
    try:
        async with stdio_server(stdin=lines(wire)) as (incoming, outgoing):  # type: ignore[arg-type]  # iterates it
            low = server._lowlevel_server  # noqa: SLF001 - what run_stdio_async does, which has no other input
            await low.run(incoming, outgoing, low.create_initialization_options())
    finally:
        os.dup2(wire, 0)
        os.close(wire)


async def lines(file: int) -> AsyncIterator[str]:
    """The lines of a file, one at a time; reading ends at once when it is cancelled.

    A line that is longer than ``LONGEST_LINE`` is passed on cut, which is no message any more.
    """
    import anyio

    rest, skipping = b"", False
    while True:
        try:
            await anyio.wait_readable(file)
        except OSError:  # a file on a disk is always ready, and cannot be waited for
            await anyio.sleep(0)
        chunk = os.read(file, _CHUNK)
        *whole, rest = (rest + chunk).split(b"\n")
        for line in whole:
            if not skipping:
                yield line.decode(errors="replace")
            skipping = False
        if len(rest) > LONGEST_LINE:
            if not skipping:
                yield rest[:80].decode(errors="replace")
            rest, skipping = b"", True
        if not chunk:
            if rest and not skipping:
                yield rest.decode(errors="replace")
            return
