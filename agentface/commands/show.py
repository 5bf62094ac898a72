"""``agentface show``: the window."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

import click

from agentface.commands.ending import until_told
from agentface.commands.options import face_options, live_quality_option, liveliness_option, look_option, make_face
from agentface.commands.streams import say

if TYPE_CHECKING:
    from agentface.face import Face
    from agentface.window.window import Window


@click.command()
@live_quality_option
@look_option
@liveliness_option
@face_options
def show(*, quality: str | None, look: str | None, liveliness: float, face: str, deformer: str) -> None:
    """Open the live window: a panel with sliders, keys 1 to 6 for the emotions, the mouse for the view."""
    shown = make_face(face, deformer, look=look, running=True, liveliness=liveliness)
    with until_told() as ending:
        make_window(shown, look=look, quality=quality).run(stopped=ending.told)


def make_window(
    face: Face,
    say: Callable[[str], object] = say,
    look: str | None = None,
    quality: str | None = None,
    camera: str = "front",
) -> Window:
    """A window that writes pictures and films into the current folder; ``quality``: what suits the driver if None."""
    from agentface.head.look import load_look
    from agentface.io.picture import write_picture
    from agentface.io.video import VideoWriter
    from agentface.window.capture import Capture
    from agentface.window.window import Window

    capture = Capture(write_picture, partial(VideoWriter, keep=True), say)
    window = Window(face, capture=capture, look=load_look(face.model, look), say=say, quality=quality)
    window.controls.look(camera)
    return window
