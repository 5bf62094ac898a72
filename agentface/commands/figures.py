"""``agentface figures``: the pictures of the documents."""

from __future__ import annotations

from pathlib import Path

import click

from agentface.commands.options import face_options


@click.command()
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    default=Path("docs/images"),
    metavar="FOLDER",
    show_default=True,
    help="Where to write.",
)
@face_options
def figures(*, output: Path, face: str, deformer: str) -> None:
    """Draw the comparison of the ways to combine muscles, for docs/muscles.md."""
    from agentface.face import check_deformer
    from agentface.figures.combination import FIGURES, combination_figures
    from agentface.io.files import check_writable, write_file

    check_deformer(deformer)
    check_writable(output / f"{next(iter(FIGURES))}.png")
    for name, content in combination_figures(face).items():
        write_file(output / name, content)
        click.echo(f"{output / name}: {len(content) / 1024:.0f} kB")
