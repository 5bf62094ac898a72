"""``agentface show``: the window."""

from __future__ import annotations

import click

from agentface.commands.options import face_options, make_face


@click.command()
@face_options
def show(*, face: str, deformer: str) -> None:
    """Open the live window: keys 1 to 6 raise an emotion each, the mouse turns the view."""
    from agentface.view.window import Window

    shown = make_face(face, deformer)
    shown.warm_up()
    Window(shown).run()
