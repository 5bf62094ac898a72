"""``agentface check``: every fault of data files, with file and line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

import click

from agentface.commands.options import deformer_option
from agentface.errors import DataError, Fault, InvalidValueError

if TYPE_CHECKING:
    from agentface.mesh.glb import MeshArrays

_Loader = Callable[[Path], object]


@click.command()
@click.argument("files", nargs=-1, type=click.Path(path_type=Path), metavar="[FILE|FOLDER]...")
@click.option("--face", metavar="NAME|PATH", help="A face to check.")
@click.option("--strict", is_flag=True, help="Notes, of what a document says and the face does not show, are faults.")
@deformer_option
def check(*, files: tuple[Path, ...], face: str | None, strict: bool, deformer: str) -> None:
    """Check rules, faces and performances: files, folders, or, if none is named, all that come with agentface.

    Performances are EmotionML, BML, .fap, tables of OpenFace, py-feat and Live Link Face, and poses in .json and .npz;
    a .json may also have the times of a recording's phones.

    Prints every fault with file and line; the exit code is 1 if there is any. A face need not have a tissue.yaml,
    unless --deformer is one that moves tissue.
    """
    from agentface.deform.protocol import TISSUE_DEFORMERS, check_deformer
    from agentface.resources import face_folder

    check_deformer(deformer)
    tissue = deformer in TISSUE_DEFORMERS
    places = [*files, *([face_folder(face)] if face else [])] or _shipped()
    faults: list[Fault] = []
    for place in places:
        found = list(dict.fromkeys(faults_of(place, tissue=tissue)))
        notes = [] if found else _notes_of(place)
        if strict:
            found, notes = found + notes, []
        faults += found
        plural = "" if len(found) == 1 else "s"
        click.echo(f"{place}: {len(found)} fault{plural}" if found else f"{place}: good")
        for fault in found:
            click.echo(f"  {fault}")
        for note in notes:
            click.echo(f"  note: {note}")
    if faults:
        raise SystemExit(1)


def _shipped() -> list[Path]:
    from agentface.resources import data_folder, face_folder, face_names
    from agentface.tissue.reading import anatomy_file

    return [data_folder("rules"), anatomy_file(), *(face_folder(name) for name in face_names())]


def faults_of(place: str | Path, *, tissue: bool = False) -> list[Fault]:
    """Every fault of a file, of a folder of rules, or of a face's folder; ``tissue``: that it has none is one."""
    from agentface.tissue.tissue_file import TISSUE_FILE

    place = Path(place)
    if not place.exists():
        return [Fault(place, None, "", "a file or a folder", "nothing")]
    if not place.is_dir():
        return _faults_of_file(place)
    names = {path.name for path in place.iterdir()}
    if names & set(_rule_readers()):
        return [fault for name in _rule_readers() for fault in _faults_of_file(place / name)]
    if not names & (_face_readers().keys() - {TISSUE_FILE}):  # the anatomist's lies beside the faces' folders
        return [Fault(place, None, "", "a folder with rules or a face", "neither")]
    tables = [place / name for name in _face_readers() if name in names or name != TISSUE_FILE]
    looks = sorted((place / "looks").glob("*.yaml"))
    found = [fault for path in [*tables, *looks] for fault in _faults_of_file(path)]
    return found or _faults_in(lambda: _whole_face(place, tissue))


def _faults_of_file(path: Path) -> list[Fault]:
    readers = _rule_readers() | _face_readers()
    kind = "look.yaml" if path.parent.name == "looks" else path.name
    if kind in readers:
        return _faults_in(lambda: readers[kind](path))
    if path.suffix.lower() in (".yaml", ".yml", ".glb"):
        return [Fault(path, None, "", f"one of {', '.join(readers)}, or a performance", path.name)]
    from agentface.io.performances.kinds import load
    from agentface.io.recorded_speech import is_phones_file, read_recorded

    return _faults_in(lambda: read_recorded(path) if is_phones_file(path) else load(path))


def _notes_of(path: Path) -> list[Fault]:
    """What of a performance without faults is not shown as it is written."""
    from agentface.io.performances.kinds import load
    from agentface.io.recorded_speech import is_phones_file

    if not path.is_file() or path.suffix.lower() in (".yaml", ".yml", ".glb") or is_phones_file(path):
        return []
    return list(getattr(load(path)[1], "notes", ()))


def _faults_in(read: Callable[[], object]) -> list[Fault]:
    try:
        read()
    except DataError as error:
        return list(error.faults)
    return []


def _rule_readers() -> dict[str, _Loader]:
    from agentface.agents.faces import load_faces
    from agentface.bml.table import load_bml_table
    from agentface.emotion.envelopes import load_envelopes
    from agentface.emotion.tables import load_blends, load_emotions
    from agentface.emotion.vocabularies import load_vocabularies
    from agentface.facs.action_units import load_action_units
    from agentface.motion.conflicts import load_conflicts
    from agentface.motion.figures import load_life
    from agentface.motion.gestures.table import load_gestures
    from agentface.mpeg4.fap_table import load_faps
    from agentface.speech.alphabets import load_phones
    from agentface.speech.visemes import load_visemes
    from agentface.vrm.expressions import load_expressions

    return {
        "emotions.yaml": load_emotions,
        "blends.yaml": load_blends,
        "bml.yaml": load_bml_table,
        "action_units.yaml": load_action_units,
        "agents.yaml": load_faces,
        "conflicts.yaml": load_conflicts,
        "envelopes.yaml": load_envelopes,
        "faps.yaml": load_faps,
        "phones.yaml": load_phones,
        "gestures.yaml": load_gestures,
        "life.yaml": load_life,
        "visemes.yaml": load_visemes,
        "vocabularies.yaml": load_vocabularies,
        "vrm.yaml": load_expressions,
    }


def _face_readers() -> dict[str, _Loader]:
    from agentface.head.look import read_look
    from agentface.head.model import TABLES
    from agentface.mesh.glb import read_glb
    from agentface.tissue.reading import read_tissue
    from agentface.tissue.tissue_file import TISSUE_FILE

    tables = {name: _beside_its_skin(read) for name, read in TABLES.items()}
    return {"head.glb": read_glb, **tables, "look.yaml": read_look, TISSUE_FILE: read_tissue}


def _beside_its_skin(read: Callable[[Path, MeshArrays], object]) -> _Loader:
    return lambda path: read(path, _skin_beside(path))


def _skin_beside(beside: Path) -> MeshArrays:
    from agentface.mesh.glb import read_glb

    path = beside.parent / "head.glb"
    meshes = read_glb(path)
    if "skin" not in meshes:
        raise DataError([Fault(path, None, "skin", "a mesh of this name", "none")])
    return meshes["skin"]


def _whole_face(folder: Path, tissue: bool) -> None:
    """What only the files together show: whether muscles, wrinkles, lips, lids and the rest can be made of them."""
    from agentface.deform import tables
    from agentface.head.model import load_model
    from agentface.tissue.soundness import check_tissue
    from agentface.tissue.tissue_file import TISSUE_FILE

    model = load_model(folder)
    makes: list[Callable[[], object]] = [
        lambda: model.muscles,
        lambda: model.trains,
        lambda: tables.prepare(model),
    ]
    if tissue or (folder / TISSUE_FILE).exists():
        makes.append(lambda: check_tissue(model))
    found: list[Fault] = []
    for make in makes:
        try:
            make()
        except InvalidValueError as error:
            found.append(_located(folder, error))
        except DataError as error:
            found += error.faults
    if found:
        raise DataError(list(dict.fromkeys(found)))


def _located(folder: Path, error: InvalidValueError) -> Fault:
    from agentface.config import Document

    if error.place is None:
        return Fault(folder, None, error.where, error.expected, str(error.got), error.hint)
    path, where = folder / error.place.file, error.place.where
    line = Document(path).line(where) if path.suffix == ".yaml" else None
    return Fault(path, line, ".".join(map(str, where)), error.expected, str(error.got), error.hint)
