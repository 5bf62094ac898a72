"""``--web`` and what goes with it: faces in web pages beside what a command does."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial, wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from agentface.commands.options import optional_address
from agentface.commands.progress import progress
from agentface.commands.streams import say, tell

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.io.web.server import WebServer

_Command = TypeVar("_Command", bound=Callable[..., Any])
_WEB = "Serve a page with the face, such as 127.0.0.1:8080, and take the messages of OSC as JSON; needs the extra web."
_TOKEN = "What --web asks of everyone; beyond this machine, one is made if it is not given."  # noqa: S105  # words
_ORIGIN = "A web site, such as https://example.org, whose pages may ask --web, too."


@dataclass(frozen=True, slots=True)
class PagesAsked:
    """Where pages are served, and who may ask."""

    address: tuple[str, int]
    token: str | None
    origins: tuple[str, ...]


def web_options(command: _Command) -> _Command:
    """Add ``--web``, ``--token`` and ``--allow-origin``, given to the command as one ``pages``, None without them."""

    @wraps(command)
    def packed(
        *arguments: Any, web: tuple[str, int] | None, token: str | None, origins: tuple[str, ...], **others: Any
    ) -> Any:
        return command(*arguments, pages=None if web is None else PagesAsked(web, token, origins), **others)

    found: Any = packed
    for option in (
        click.option("--allow-origin", "origins", multiple=True, metavar="URL", help=_ORIGIN),
        click.option("--token", metavar="TOKEN", help=_TOKEN),
        click.option("--web", callback=optional_address, metavar="HOST:PORT", help=_WEB),
    ):
        found = option(found)
    typed: _Command = found
    return typed


@contextmanager
def served_pages(
    faces: Mapping[str, Face], asked: PagesAsked | None, deformer: str, look: str | None, fps: float
) -> Iterator[list[WebServer]]:
    """The server of pages, if one is asked for; the terminal is told where it is and who may ask."""
    if asked is None:
        yield []
        return
    from agentface.io.web.server import WebServer
    from agentface.io.web.stage import basis_of

    measure = partial(basis_of, watched=partial(progress, total=1.0))
    options: dict[str, Any] = {"token": asked.token, "origins": asked.origins, "told": tell, "measure": measure}
    with WebServer(faces, *asked.address, deformer=deformer, look=look, fps=fps, **options) as server:
        for line in (f"the page is {server.url}", *server.access.told("it")):
            say(line)
        yield [server]
