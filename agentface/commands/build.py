"""``agentface build``: makes a face from its recipe."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import click

from agentface.commands.options import face_options
from agentface.commands.streams import console
from agentface.errors import DataError, InvalidValueError

_BORROWED = ("muscles.yaml", "tissue.yaml", "asymmetry.yaml", "look.yaml")


@click.command()
@click.argument("recipe", type=click.Path(path_type=Path))
@click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FOLDER", help="The face's folder, instead of your own."
)
@click.option("--source", type=click.Path(path_type=Path), metavar="FOLDER", help="Where the base mesh is, or goes.")
@face_options
def build(*, recipe: Path, output: Path | None, source: Path | None, face: str, deformer: str) -> None:
    """Make a face from RECIPE, a YAML file such as regions/amber/recipe.yaml, and write its folder.

    Without -o it goes to your own faces (regions in AGENTFACE_DATA, or ~/.local/share/agentface/regions), where --face
    finds it by its name: that of the recipe's file or, if that is recipe.yaml, of its folder. The base mesh is
    downloaded once, 48 MB. What the recipe does not say (muscles.yaml, tissue.yaml, asymmetry.yaml, look.yaml) is
    copied from --face, unless the folder has it already; agentface calibrate then fits the muscles, and with
    --deformer tissue those of the tissue.
    """
    from agentface.deform.protocol import check_deformer
    from agentface.head.build.source import fetch, source_folder
    from agentface.io.files import make_folder, write_file
    from agentface.resources import face_folder

    check_deformer(deformer)
    folder = (output or _own_folder(recipe)).expanduser().resolve()
    lender = face_folder(face)
    make_folder(folder.parent)
    with _steps() as step:
        step("fetching the base mesh")
        data = fetch(source or source_folder())
        files = _files(folder.name, recipe, data, step)
        for name in _BORROWED:
            files[name] = borrowed(name, folder, lender).read_bytes()
        step("checking the face")
        _check(files, folder)
    make_folder(folder)
    for name, content in files.items():
        write_file(folder / name, content)
    click.echo(f"{folder}: written; agentface show --face {_named(folder)} shows it")


def borrowed(name: str, folder: Path, lender: Path) -> Path:
    """Where a file of the new face comes from: its folder, the lender's, or, for the tissue, the anatomist's table."""
    from agentface.tissue.reading import anatomy_file

    anatomist = anatomy_file()
    places = [folder / name, lender / name, *([anatomist] if name == anatomist.name else [])]
    return next((place for place in places if place.is_file()), lender / name)


def _own_folder(recipe: Path) -> Path:
    from agentface.resources import face_names, user_faces_folder

    absolute = recipe.expanduser().resolve()
    name = absolute.parent.name if recipe.stem == "recipe" else recipe.stem
    if name in face_names():
        hint = "copy the recipe under another name, or say where with -o"
        raise InvalidValueError("the new face's name", "another than those of agentface's own faces", name, hint)
    return user_faces_folder() / name


def _named(folder: Path) -> str:
    """What ``--face`` takes for the folder."""
    from agentface.resources import user_face_names, user_faces_folder

    own = folder.parent == user_faces_folder().resolve() and folder.name in user_face_names()
    return folder.name if own else str(folder)


def _files(name: str, path: Path, data: Path, step: Callable[[str], None]) -> dict[str, bytes]:
    from agentface.head.build.face_files import face_files
    from agentface.head.build.head_topology import HeadTopology
    from agentface.head.build.identity import read_recipe
    from agentface.head.build.source import BaseMesh

    step("reading the base mesh")
    mesh = BaseMesh(data)
    recipe = read_recipe(path, mesh)
    step("cutting and refining the mesh")
    topology = HeadTopology(mesh)
    step("mixing the person")
    text = path.read_text(encoding="utf-8")
    return {"recipe.yaml": text.encode(), **face_files(name, recipe, text, topology)}


def _check(files: dict[str, bytes], folder: Path) -> None:
    """Raise DataError when they are no whole face, before anything of an older one is overwritten."""
    from agentface.commands.check import faults_of

    with tempfile.TemporaryDirectory() as temporary:
        for name, content in files.items():
            (Path(temporary) / name).write_bytes(content)
        faults = faults_of(Path(temporary))
    if faults:
        raise DataError([replace(fault, file=folder / fault.file.name) for fault in faults])


@contextmanager
def _steps() -> Iterator[Callable[[str], None]]:
    """A call that says what is done now; each step is shown with the time that it took."""
    from rich.progress import Progress, SpinnerColumn, TextColumn, TimeElapsedColumn

    columns = (SpinnerColumn(finished_text=" "), TextColumn("{task.description}"), TimeElapsedColumn())
    with Progress(*columns, console=console()) as progress:

        def step(description: str) -> None:
            for task in progress.task_ids:
                progress.update(task, total=1, completed=1)
            progress.add_task(description, total=None)

        yield step
        for task in progress.task_ids:
            progress.update(task, total=1, completed=1)
