"""``agentface mcp``: a face that a language model moves."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager
from typing import TYPE_CHECKING, Any

import click

from agentface.commands.ending import Ending, until_told
from agentface.commands.options import (
    face_options,
    given,
    live_quality_option,
    liveliness_option,
    look_option,
    make_face,
    optional_address,
)
from agentface.commands.streams import tell
from agentface.errors import AgentFaceError, GraphicsError

if TYPE_CHECKING:
    from mcp.server.mcpserver import MCPServer

    from agentface.agents.mcp.actor import Actor
    from agentface.face import Face

_HTTP = "Serve over HTTP instead, such as 127.0.0.1:8090."
_FPS = 60.0
_NO_WINDOW = """A client of MCP hands on next to nothing of its environment: have it set "env": {"DISPLAY": ":0"}.
Without a window:  agentface mcp --view none"""


@click.command()
@click.option("--http", callback=optional_address, metavar="HOST:PORT", help=_HTTP)
@click.option(
    "--token", metavar="TOKEN", help="What --http asks of everyone; beyond this machine one is made if not given."
)
@click.option(
    "--allow-origin", "origins", multiple=True, metavar="URL", help="A web site whose pages may ask --http, too."
)
@click.option(
    "--view",
    type=click.Choice(["window", "none"]),
    default="window",
    show_default=True,
    help="Where a person sees the face; a model asks for pictures in either case.",
)
@look_option
@liveliness_option
@live_quality_option
@face_options
@click.pass_context
def mcp(
    ctx: click.Context,
    *,
    http: tuple[str, int] | None,
    token: str | None,
    origins: tuple[str, ...],
    view: str,
    look: str | None,
    liveliness: float,
    quality: str | None,
    face: str,
    deformer: str,
) -> None:
    """Serve the Model Context Protocol: a language model shows emotions, speaks, looks and nods by tools.

    A program starts it, and talks to it over the standard input and output; it ends with them. Needs the extra mcp.

    \b
    {"mcpServers": {"face": {"command": "agentface", "args": ["mcp"]}}}
    agentface mcp --http 127.0.0.1:8090 --view none
    """  # noqa: D301 - \b is click's mark of lines to keep
    options = given(ctx)
    for name, there, goes_with in (
        ("token", http is not None, "--http"),
        ("origins", http is not None, "--http"),
        ("quality", view == "window", "--view window"),
    ):
        if name in options and not there:
            shown = {"origins": "allow-origin"}.get(name, name)
            raise click.UsageError(f"--{shown} goes with {goes_with}")
    from agentface.agents.mcp.actor import Actor
    from agentface.agents.mcp.server import face_server
    from agentface.head.model import load_model

    with until_told() as ending, closing(Actor(load_model(face), look)) as actor:
        server = face_server(actor)
        # a client that starts the server waits for its first answer, and not for kernels that are compiled
        serving = _over_http(server, http, token, origins) if http else _over_stdio(server, ending)
        with serving:
            made = make_face(face, deformer, look=look, running=True, liveliness=liveliness)
            with _heard(made):
                actor.made.set_result(made)
                _show(made, actor, ending, view, look, quality)


@contextmanager
def _over_http(
    server: MCPServer[Any], http: tuple[str, int], token: str | None, origins: tuple[str, ...]
) -> Iterator[None]:
    from agentface.agents.mcp.http import serve_http

    with serve_http(server, *http, token=token, origins=origins) as address:
        for line in (f"the tools are at {address.url}", *address.access.told("it")):
            tell(line)
        yield


@contextmanager
def _over_stdio(server: MCPServer[Any], ending: Ending) -> Iterator[None]:
    """Serve in a thread, whose end, which is that of the input, ends the program; and the other way round."""
    import anyio

    from agentface.agents.mcp.stdio import serve_stdio

    over = threading.Event()

    async def serve() -> None:
        async with anyio.create_task_group() as group:
            group.start_soon(watch, group.cancel_scope)
            await serve_stdio(server)
            group.cancel_scope.cancel()

    async def watch(scope: anyio.CancelScope) -> None:
        while not over.is_set():
            await anyio.sleep(0.1)
        scope.cancel()

    def work() -> None:
        try:
            anyio.run(serve)
        except Exception as error:  # told, as nobody waits for a thread's error
            tell(f"agentface: the MCP server ended: {type(error).__name__}: {error}")
        ending.note(0)

    thread = threading.Thread(target=work, name="agentface-mcp", daemon=True)
    thread.start()
    try:
        yield
    finally:
        over.set()
        thread.join()


@contextmanager
def _heard(face: Face) -> Iterator[None]:
    """The face's voice on the machine's device."""
    from agentface.io.voice_output import VoiceOutput

    def complain(error: AgentFaceError) -> None:
        tell(str(error))

    face.talker.failed.append(complain)
    with VoiceOutput(face.talker, tell):
        yield


def _show(face: Face, actor: Actor, ending: Ending, view: str, look: str | None, quality: str | None) -> None:
    if view == "none":
        from agentface.clock import SystemClock
        from agentface.live.loop import run

        run(face, SystemClock(), [actor], fps=_FPS, stopped=ending.told)
        return
    from agentface.commands.show import make_window

    try:
        window = make_window(face, tell, look=look, quality=quality)
    except GraphicsError as error:
        raise GraphicsError(f"{error}\n{_NO_WINDOW}") from error
    window.run([actor], stopped=ending.told)
