"""Finds the data folders ``regions``, ``rules`` and ``shaders``: in an installed wheel or in a checkout."""

from __future__ import annotations

from functools import cache
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


def cache_folder() -> Path | None:
    """Where downloaded and computed files may be kept between runs; None where the user has no home."""
    import os

    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "agentface"
    except RuntimeError:  # no HOME, and no such user
        tell_no_cache(Path("~/.cache"), OSError("no home folder"))
        return None


def keep_newest(folder: Path, count: int) -> None:
    """Remove all but the ``count`` entries of ``folder`` that were used last; others may be removing them, too."""
    import shutil

    entries = sorted(folder.iterdir(), key=lambda entry: entry.stat().st_mtime, reverse=True)
    for entry in entries[count:]:
        if entry.is_dir():
            shutil.rmtree(entry, ignore_errors=True)
        else:
            entry.unlink(missing_ok=True)


@cache
def _tell_once() -> None:
    import logging

    logging.getLogger("agentface").warning(
        "nothing can be kept between runs (%s): every start computes anew; set XDG_CACHE_HOME to a folder to write in",
        _TOLD[0],
    )


_TOLD: list[str] = []


def tell_no_cache(place: Path, error: OSError) -> None:
    """Log, once a process, that ``place`` cannot hold what was computed."""
    _TOLD.append(f"{place}: {error.strerror or error}")
    _tell_once()
