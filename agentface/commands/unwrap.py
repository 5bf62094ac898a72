"""``agentface unwrap``: a picture to paint the skin on."""

from __future__ import annotations

from pathlib import Path

import click

from agentface.commands.options import face_options, look_option


@click.command()
@look_option
@click.option(
    "--size", type=click.IntRange(64, 4096), default=2048, metavar="N", show_default=True, help="Its side in pixels."
)
@click.option("--lines", is_flag=True, help="Draw the mesh's edges and the names of landmarks over it: a guide.")
@click.option("-o", "--output", type=click.Path(path_type=Path), required=True, metavar="FILE.png")
@face_options
def unwrap(*, look: str | None, size: int, lines: bool, output: Path, face: str, deformer: str) -> None:
    """Write the skin of a face as a flat picture to paint on.

    Paint it, and name it in a look's file for every other command to wear it: skin: {..., texture: FILE.png}
    """
    from agentface.deform.protocol import check_deformer
    from agentface.head.look import load_look
    from agentface.head.model import load_model
    from agentface.io.files import check_writable
    from agentface.io.picture import check_picture_name, write_picture
    from agentface.view.skin.template import skin_template

    check_deformer(deformer)
    check_picture_name(output, alpha=True)
    check_writable(output)
    model = load_model(face)
    picture = skin_template(model, load_look(model, look), size)
    if lines:
        from agentface.view.skin.guides import with_guides

        picture = with_guides(picture, model)
    write_picture(output, picture)
