"""The options of ``agentface serve`` for the VMC protocol, and the links that they ask for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, nullcontext
from dataclasses import dataclass
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

import click

from agentface.commands.links import Links
from agentface.commands.options import optional_address, wait_told

if TYPE_CHECKING:
    from agentface.face import Face

_Command = TypeVar("_Command", bound=Callable[..., Any])
_NAMES = ["vrm0", "vrm1", "perfect-sync", "arkit"]
_OPTIONS = (
    click.option(
        "--vmc",
        default=None,
        callback=optional_address,
        metavar="HOST:PORT",
        help="Show the face on an avatar that listens to the VMC protocol there, as on 127.0.0.1:39539.",
    ),
    click.option(
        "--vmc-names",
        type=click.Choice(_NAMES),
        default="vrm0",
        show_default=True,
        help="What that avatar calls its shapes: the presets of VRM 0 or 1, or ARKit's 52 in avatars of VRM 0 or 1.",
    ),
    click.option(
        "--vmc-in",
        default=None,
        callback=optional_address,
        metavar="HOST:PORT",
        help="Listen there to a tracker that speaks VMC, and do as it says.",
    ),
    click.option(
        "--vmc-axes",
        type=click.Choice(["unity", "gltf"]),
        default="unity",
        show_default=True,
        help="The axes of bones in VMC: left-handed as in Unity, or right-handed as in glTF.",
    ),
    click.option(
        "--vmc-eyes",
        type=click.Choice(["bones", "shapes"]),
        default="bones",
        show_default=True,
        help="By what the avatar's eyes turn.",
    ),
    click.option("--vmc-id", metavar="ID", help="Which of several faces VMC is for; the first otherwise."),
)


_PLACES = {
    "to": "vmc",
    "listen": "vmc_in",
    "names": "vmc_names",
    "axes": "vmc_axes",
    "eyes": "vmc_eyes",
    "id": "vmc_id",
}


@dataclass(frozen=True, slots=True)
class VmcOptions:
    """What the command line says.

    Attributes:
        to: host and port of an avatar.
        listen: host and port for a tracker.
        names: of the avatar's shapes.
        axes: of the bones.
        eyes: by what the avatar's turn.
        id: of the face.
    """

    to: tuple[str, int] | None
    listen: tuple[str, int] | None
    names: str
    axes: str
    eyes: str
    id: str | None

    @property
    def asked(self) -> bool:
        """Whether anything is linked."""
        return self.to is not None or self.listen is not None

    def first(self, faces: Mapping[str, Face]) -> dict[str, Face]:
        """The faces, that which is linked before the others; raises UsageError for an id that none of them has."""
        if self.id is None:
            return dict(faces)
        if self.id not in faces:
            raise click.UsageError(f"--vmc-id: expected one of {', '.join(faces)}, got {self.id!r}")
        return {self.id: faces[self.id], **faces}


def vmc_options(command: _Command) -> Callable[..., Any]:
    """Adds the options to a command, which gets them as ``vmc: VmcOptions``."""

    @wraps(command)
    def wrapper(*args: Any, **given: Any) -> Any:
        said = {name: given.pop(place) for name, place in _PLACES.items()}
        return command(*args, vmc=VmcOptions(**said), **given)

    for option in reversed(_OPTIONS):
        wrapper = option(wrapper)
    return wrapper


def check_vmc(given: set[str], options: VmcOptions) -> None:
    """Raise UsageError for an option that does nothing, and for a face that would drive itself."""
    for name, goes_with, there in (
        ("vmc_names", "--vmc", options.to is not None),
        ("vmc_eyes", "--vmc", options.to is not None),
        ("vmc_axes", "--vmc or --vmc-in", options.asked),
        ("vmc_id", "--vmc or --vmc-in", options.asked),
    ):
        if name in given and not there:
            raise click.UsageError(f"--{name.replace('_', '-')} goes with {goes_with}")
    if options.to is not None and options.to == options.listen:
        raise click.UsageError("expected --vmc and --vmc-in on different ports: the face would drive itself")


@contextmanager
def vmc_links(name: str, face: Face, options: VmcOptions) -> Iterator[Links]:
    """The links of one face while the block runs; its status tells of them."""
    from agentface.io.vmc.names import are_presets
    from agentface.io.vmc.receiver import VmcReceiver
    from agentface.io.vmc.sender import VmcSender
    from agentface.live.newest import LiveSink

    links = Links()
    with ExitStack() as stack:
        if options.listen is not None:
            with wait_told(name, compiled=True):
                receiver = stack.enter_context(VmcReceiver(face, *options.listen, axes=options.axes))
            links.sources.append(receiver)
            links.told.append(f"{name} is driven by VMC on {receiver.host}:{receiver.port}")
            face.reports["vmc_in"] = lambda: receiver.status
        if options.to is not None:
            with wait_told(name, compiled=True):
                made = VmcSender(face, *options.to, names=options.names, axes=options.axes, eyes=options.eyes)
                sender = stack.enter_context(made)
            links.told.append(f"{name} is sent by VMC to {sender.to}, with names of {options.names}")
            links.sinks.append(sender)
            face.reports["vmc"] = lambda: sender.status
            if not are_presets(options.names):  # they need the pose alone, and milliseconds that the face need not wait
                links.sinks[-1] = stack.enter_context(LiveSink(lambda: nullcontext(sender)))
        yield links
