"""``agentface figures``: the pictures of the documents."""

from __future__ import annotations

from pathlib import Path

import click

from agentface.commands.options import face_options


@click.command()
@click.argument("names", nargs=-1, metavar="[NAME]...")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    default=Path("figures"),
    metavar="FOLDER",
    show_default=True,
    help="Where to write; made if need be.",
)
@face_options
def figures(*, names: tuple[str, ...], output: Path, face: str, deformer: str) -> None:
    """Draw the figures of the papers with this face, and the other pictures of the documents: all, or some by NAME."""
    from agentface.deform.protocol import check_deformer
    from agentface.errors import UnknownNameError
    from agentface.io.files import check_writable, make_folder, write_file
    from agentface.studies.figures import FIGURES, draw

    check_deformer(deformer)
    for name in names:
        if name not in FIGURES:
            raise UnknownNameError("figure", name, tuple(FIGURES))
    if output.absolute().parent.is_dir():
        make_folder(output)
    check_writable(output / "figure.png")
    for name in names or tuple(FIGURES):
        click.echo(f"{name}: {FIGURES[name]}")
        for file, content in draw(face, (name,), deformer):
            write_file(output / file, content)
            click.echo(f"  {output / file}: {len(content) / 1024:.0f} kB")
