"""Options that commands share, and how their values are read."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

import click
from click.core import ParameterSource

from agentface.commands.streams import console
from agentface.resources import DEFAULT_FACE

if TYPE_CHECKING:
    from agentface.face import Face

_COMPILING = "compiling for this machine, which takes about a minute once"
_Command = TypeVar("_Command", bound=Callable[..., Any])


def assignments(_: click.Context, __: click.Parameter, values: Sequence[str]) -> dict[str, float]:
    """``NAME=V``, several times or several joined by commas, as a mapping."""
    return read_assignments(values)


def read_assignments(values: Sequence[str]) -> dict[str, float]:
    """The mapping that texts of ``NAME=V``, joined by commas, mean; raises BadParameter."""
    merged: dict[str, float] = {}
    for part in (part.strip() for value in values for part in value.split(",")):
        name, _equals, number = part.partition("=")
        if name in merged:
            raise click.BadParameter(f"expected each name once, got {name!r} twice")
        try:
            merged[name] = float(number)
        except ValueError:
            raise click.BadParameter(f"expected NAME=V with a number, got {part!r}; for example fear=0.8") from None
    return merged


def size(_: click.Context, __: click.Parameter, value: str) -> tuple[int, int]:
    """``WxH`` in pixels."""
    width, _x, height = value.lower().partition("x")
    if not (width.isdecimal() and height.isdecimal() and 1 <= int(width) <= 8192 and 1 <= int(height) <= 8192):
        raise click.BadParameter(f"expected WxH with numbers in 1..8192, got {value!r}; for example 1280x720")
    return int(width), int(height)


def angles(_: click.Context, __: click.Parameter, value: str | None) -> tuple[float, float] | None:
    """``YAW,PITCH`` in degrees."""
    if value is None:
        return None
    try:
        yaw, pitch = (float(part) for part in value.split(","))
    except ValueError:
        raise click.BadParameter(f"expected YAW,PITCH in degrees, got {value!r}; for example 10,-5") from None
    return yaw, pitch


def point(_: click.Context, __: click.Parameter, value: str | None) -> tuple[float, float, float] | None:
    """``X,Y,Z`` in metres."""
    if value is None:
        return None
    try:
        x, y, z = (float(part) for part in value.split(","))
    except ValueError:
        raise click.BadParameter(f"expected X,Y,Z in metres, got {value!r}; for example 0,0,0.5") from None
    return x, y, z


def address(_: click.Context, __: click.Parameter, value: str) -> tuple[str, int]:
    """``HOST:PORT``."""
    host, _colon, port = value.rpartition(":")
    if not (host and port.isdecimal() and int(port) <= 65535):
        raise click.BadParameter(f"expected HOST:PORT with a port up to 65535, got {value!r}")
    return host.strip("[]"), int(port)


def optional_address(ctx: click.Context, option: click.Parameter, value: str | None) -> tuple[str, int] | None:
    """``HOST:PORT``, or nothing."""
    return None if value is None else address(ctx, option, value)


AskedUnit: TypeAlias = tuple[str, str | float, str | None]
"""An action unit's number, its intensity or letter, its side."""


def action_units(_: click.Context, __: click.Parameter, values: Sequence[str]) -> list[AskedUnit]:
    """``N=V``, ``N=LETTER``, or for one side ``NL=V`` or ``NR=V``, several times or joined by commas or plus signs."""
    found: list[AskedUnit] = []
    for part in (part.strip() for value in values for part in value.replace("+", ",").split(",")):
        match = re.fullmatch(r"(?:AU)?\s*(\d+)([LR]?)\s*=\s*(.+)", part, re.IGNORECASE)
        if match is None:
            raise click.BadParameter(f"expected N=V, got {part!r}; for example 12=0.8, 12=C or, on the left, 12L=0.8")
        number, side, level = match.groups()
        try:
            intensity: str | float = float(level)
        except ValueError:
            intensity = level
        found.append((number, intensity, side.lower() or None))
    return found


action_unit_option = click.option(
    "--au",
    "action_units",
    multiple=True,
    callback=action_units,
    metavar="N=V",
    help="An action unit of FACS, 0..1 or a letter A to E; 12L=0.8 for the left side alone.",
)
emotion_option = click.option(
    "--emotion",
    "emotions",
    multiple=True,
    callback=assignments,
    metavar="NAME=V",
    help="An emotion, 0..1.",
)
size_option = click.option(
    "--size", default="1280x720", callback=size, metavar="WxH", show_default=True, help="Width and height in pixels."
)
camera_option = click.option(
    "--camera", type=click.Choice(["front", "three-quarter", "profile"]), default="front", show_default=True
)
quality_option = click.option("--quality", type=click.Choice(["fast", "portrait"]), default="fast", show_default=True)
live_quality_option = click.option(
    "--quality",
    type=click.Choice(["fast", "portrait"]),
    help="If not given: fast, but portrait in a window where there is a GPU.",
)
look_option = click.option(
    "--look", metavar="NAME|PATH", help="Another look than the face's own: a file of its folder looks, or a path."
)
json_option = click.option(
    "--json", "json_file", metavar="FILE", help="Write one JSON object to FILE, - for the standard output."
)


deformer_option = click.option(
    "--deformer",
    default="geometric",
    metavar="NAME",
    show_default=True,
    help="What makes a face of a pose: geometric, or tissue: soft tissue over a skull, which has mass; "
    "tissue-semi-implicit and tissue-adaptive are the same tissue with the paper's two solvers.",
)


LIVELINESS = 0.6
liveliness_option = click.option(
    "--liveliness",
    type=click.FloatRange(0, 1),
    default=LIVELINESS,
    metavar="V",
    show_default=True,
    help="How much the face lives between messages: 0, perfectly still, to 1.",
)


def given(ctx: click.Context) -> set[str]:
    """The names of the options that are on the command line."""
    return {name for name in ctx.params if ctx.get_parameter_source(name) is ParameterSource.COMMANDLINE}


def face_options(command: _Command) -> _Command:
    """Add ``--face`` and ``--deformer``."""
    face = click.option(
        "--face", default=DEFAULT_FACE, metavar="NAME|PATH", show_default=True, help="A face's name, or its folder."
    )
    return face(deformer_option(command))


def make_face(
    face: str,
    deformer: str,
    *,
    compiled: bool = True,
    look: str | None = None,
    running: bool = False,
    driven: bool = False,
    liveliness: float = 0.0,
    seed: int = 0,
) -> Face:
    """The face that the options name; not ``compiled``, it is ready sooner and slow a frame.

    ``running``: with all loaded that its first frames need, or compiled the first time on a machine; ``driven``: with
    all compiled then that the first FAP or weight of ARKit's needs, too. A terminal is told of the wait.
    """
    from agentface.face import Face
    from agentface.kernel import any_kept

    solvers = driven and not any_kept("mpeg4")
    with wait_told(face, compiled=compiled, solvers=solvers):
        made = Face(face, deformer=deformer, compiled=compiled, look=look, liveliness=liveliness, seed=seed)
        if running:
            made.warm_up(solvers=solvers)
    return made


@contextmanager
def wait_told(face: str, *, compiled: bool, solvers: bool = False) -> Iterator[None]:
    """Have a terminal told that kernels are compiled in the block, the first time on a machine, or ``solvers``."""
    terminal = console()
    if not terminal.is_terminal:
        yield
        return
    from agentface.kernel import any_kept

    # asked once: what a deformer is made of may be compiled before its kernels are
    known = not compiled or (any_kept() and not solvers)
    with terminal.status(f"preparing {face}" if known else _COMPILING):
        yield


def write_json(file: str, content: dict[str, Any]) -> None:
    """One JSON object to ``file`` or, for ``-``, to the standard output; raises OutputError."""
    import json

    text = json.dumps(content, indent=2, allow_nan=False) + "\n"
    if file == "-":
        click.echo(text, nl=False)
    else:
        from agentface.io.files import write_file

        write_file(Path(file), text.encode())
