"""Finds the data folders ``regions``, ``rules`` and ``shaders``: in an installed wheel or in a checkout."""

from __future__ import annotations

from pathlib import Path

from agentface.errors import UnknownNameError

_PACKAGE = Path(__file__).resolve().parent
DEFAULT_FACE = "amber"


def data_folder(name: str) -> Path:
    """The folder ``regions``, ``rules`` or ``shaders`` of this installation.

    A wheel carries them in ``agentface/_data``; in a checkout they lie beside the package.
    """
    installed = _PACKAGE / "_data" / name
    return installed if installed.is_dir() else _PACKAGE.parent / name


def face_names() -> tuple[str, ...]:
    """The names of the faces that come with agentface."""
    return tuple(sorted(folder.parent.name for folder in data_folder("regions").glob("*/head.glb")))


def face_folder(face: str | Path) -> Path:
    """The folder of a face, given by its name or by a path to its folder.

    Raises UnknownNameError when it is neither the name of a face nor a folder.
    """
    named = data_folder("regions") / str(face)
    if str(face) in face_names():
        return named
    given = Path(face).expanduser()
    if given.is_dir():
        return given
    raise UnknownNameError("face, or a path to a face's folder", str(face), face_names())


def rules_file(name: str) -> Path:
    """A file of ``rules/``, for example ``rules_file("emotions.yaml")``."""
    return data_folder("rules") / name
