"""``python -m agentface.head.build [FACE]...``: the faces that come with agentface, made again where they lie."""

from __future__ import annotations

from pathlib import Path

import click

from agentface.head.build.face_files import face_files
from agentface.head.build.head_topology import HeadTopology
from agentface.head.build.identity import read_recipe
from agentface.head.build.source import BaseMesh, fetch, source_folder
from agentface.resources import data_folder, face_names


@click.command()
@click.argument("faces", nargs=-1)
@click.option("--source", type=click.Path(path_type=Path), help="Where the base mesh is, or goes.")
def main(faces: tuple[str, ...], source: Path | None) -> None:
    """Build FACES (all that have a recipe, if none is named) from the CC0 base mesh."""
    topology = HeadTopology(BaseMesh(fetch(source or source_folder())))
    for face in faces or face_names():
        folder = data_folder("regions") / face
        path = folder / "recipe.yaml"
        recipe = read_recipe(path, topology.mesh)
        for name, content in face_files(face, recipe, path.read_text(encoding="utf-8"), topology).items():
            (folder / name).write_bytes(content)
        click.echo(f"{folder}: written")


if __name__ == "__main__":
    main()
