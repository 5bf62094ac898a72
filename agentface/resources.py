"""Finds the data folders ``regions``, ``rules`` and ``shaders``, of a wheel or a checkout, and a user's own faces."""

from __future__ import annotations

import os
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


def user_faces_folder() -> Path:
    """Where ``agentface build`` puts the user's own faces, and ``--face NAME`` finds them; it need not exist.

    ``regions`` in AGENTFACE_DATA, or else in ``agentface`` in XDG_DATA_HOME, or else in ``~/.local/share/agentface``.
    """
    return _user_folder() / "regions"


def user_face_names() -> tuple[str, ...]:
    """The names of the user's own faces; one that is called as a face of agentface can only be named by its path."""
    names = {folder.parent.name for folder in user_faces_folder().glob("*/head.glb")}
    return tuple(sorted(names.difference(face_names())))


def face_folder(face: str | Path) -> Path:
    """The folder of a face: of agentface's by name, of the user's by name, or a path to any face's folder.

    Raises UnknownNameError when it is neither the name of a face nor a folder.
    """
    if str(face) in face_names():
        return data_folder("regions") / str(face)
    if str(face) in user_face_names():
        return user_faces_folder() / str(face)
    given = _expanded(face)
    if given.is_dir():
        return given
    raise UnknownNameError("face, or a path to a face's folder", str(face), (*face_names(), *user_face_names()))


def _user_folder() -> Path:
    if chosen := os.environ.get("AGENTFACE_DATA"):
        return _expanded(chosen)
    return _expanded(os.environ.get("XDG_DATA_HOME") or "~/.local/share") / "agentface"


def _expanded(path: str | Path) -> Path:
    try:
        return Path(path).expanduser()
    except RuntimeError:  # nobody has a home here
        return Path(path)


def rules_file(name: str) -> Path:
    """A file of ``rules/``, for example ``rules_file("emotions.yaml")``."""
    return data_folder("rules") / name


def user_rules_file(name: str) -> Path:
    """What adds to the file of this name in ``rules/``: in ``rules`` of the user's data folder; it need not exist."""
    return _user_folder() / "rules" / name
