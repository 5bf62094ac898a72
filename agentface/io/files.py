"""Files written as a whole or not at all."""

from __future__ import annotations

import errno
import os
import tempfile
from pathlib import Path

from agentface.errors import OutputError

_HINTS = {
    errno.ENOSPC: "free some space, or choose another disk",
    errno.EDQUOT: "free some space, or choose another disk",
    errno.EFBIG: "choose a disk that takes larger files, or raise the limit (ulimit -f)",
}


def check_writable(path: str | Path) -> None:
    """Raise OutputError when ``path`` cannot become a file, before work is spent on its content."""
    path = Path(path)
    folder = path.parent
    if path.is_dir():
        raise OutputError(f"{path}: expected the name of a file, got a folder")
    if not folder.is_dir():
        raise OutputError(f"{path}: expected a file in a folder that exists, got no folder {folder}; make it first")
    if not os.access(folder, os.W_OK):
        raise OutputError(f"{path}: expected a folder that can be written to, got {folder}; choose another one")


def make_folder(folder: str | Path) -> None:
    """Make a folder, and those above it, where there is none; raises OutputError."""
    folder = Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(cannot_write(folder, error)) from error


def cannot_write(path: Path, error: Exception) -> str:
    """The message of an OutputError for what the system, or a library, said of ``path``."""
    number, reason = getattr(error, "errno", None), getattr(error, "strerror", None) or error
    hint = _HINTS.get(number or 0, "choose a folder that can be written to")
    return f"{path}: expected to write it, got: {reason}; {hint}"


def write_file(path: str | Path, content: bytes) -> None:
    """Write ``content``; raises OutputError, and then leaves what was there."""
    path = Path(path)
    check_writable(path)
    temporary = None
    try:
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=f".{path.name}.", delete=False) as file:
            temporary = Path(file.name)
            file.write(content)
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(path)
    except OSError as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        raise OutputError(cannot_write(path, error)) from error


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
