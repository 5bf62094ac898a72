"""What is computed once and kept between runs, in the user's cache folder; without one, everything works, slower.

An entry is written whole or not at all, and bears a stamp of all that it is made of, so that none can be stale.
Pickles are read from this folder only, as trusted as the compiled Python beside the package.
"""

from __future__ import annotations

import logging
import os
import pickle
import shutil
import sys
import tempfile
from collections.abc import Callable, Iterable
from contextlib import suppress
from functools import cache
from hashlib import blake2b
from pathlib import Path
from typing import TypeVar

_T = TypeVar("_T")
_PACKAGE = Path(__file__).parent
_VERSIONS = 8
"""Versions of the sources of which something is kept."""
_ENTRIES = 64
"""Prepared things that are kept of each: those that were used last."""


def cache_folder() -> Path | None:
    """Where downloaded and computed files may be kept between runs; None where the user has no home."""
    try:
        return Path(os.environ.get("XDG_CACHE_HOME") or "~/.cache").expanduser() / "agentface"
    except RuntimeError:  # no HOME, and no such user
        tell_no_cache(Path("~/.cache"), OSError("no home folder"))
        return None


def stamp_of(files: Iterable[Path], *more: str) -> str:
    """A name that changes with every file's path, size and time, and with ``more``."""
    digest = blake2b("\0".join((sys.version, *more)).encode(), digest_size=12)
    for path in files:
        status = path.stat()
        digest.update(f"\0{path}\0{status.st_size}\0{status.st_mtime_ns}".encode())
    return digest.hexdigest()


def version_folder(kind: str, sources: Iterable[Path], *more: str) -> Path | None:
    """The folder of what ``sources`` make, empty at first; None, told once, where nothing can be written."""
    root = cache_folder()
    if root is None:
        return None
    folder = root / kind / stamp_of(sources, *more)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder) as probe:
            probe.write(bytes(4096))
        os.utime(folder)
        keep_newest(folder.parent, _VERSIONS)
    except OSError as error:
        tell_no_cache(folder, error)
        return None
    return folder


def prepared(stamp: str, name: str, make: Callable[[], _T]) -> _T:
    """What ``make`` makes, taken from the last run where there is an entry of this ``name`` and ``stamp``."""
    folder = _prepared_folder()
    if folder is None:
        return make()
    path = folder / f"{stamp}-{name}"
    found: list[_T] = _read(path)
    if found:
        with suppress(OSError):  # another process has removed it, or it may only be read
            os.utime(path)
        return found[0]
    made = make()
    _write(path, made)
    return made


@cache
def _prepared_folder() -> Path | None:
    return version_folder("prepared", sorted(_PACKAGE.rglob("*.py")))


def _read(path: Path) -> list[_T]:
    try:
        with path.open("rb") as file:
            entry: list[_T] = [pickle.load(file)]  # noqa: S301  # our own, see above
    except Exception:  # missing, or damaged in whatever way: it is made anew
        return []
    return entry


def _write(path: Path, content: object) -> None:
    try:
        with tempfile.NamedTemporaryFile(dir=path.parent, prefix=".", delete=False) as file:
            try:
                pickle.dump(content, file, protocol=5)
                file.close()
                Path(file.name).replace(path)
            finally:
                Path(file.name).unlink(missing_ok=True)
        keep_newest(path.parent, _ENTRIES)
    except OSError as error:
        tell_no_cache(path, error)


def keep_newest(folder: Path, count: int) -> None:
    """Remove all but the ``count`` entries of ``folder`` with the latest times; others may be removing them, too."""
    times: list[tuple[float, Path]] = []
    for entry in folder.iterdir():
        try:
            times.append((entry.stat().st_mtime, entry))
        except FileNotFoundError:
            continue
    for _, entry in sorted(times, reverse=True)[count:]:
        if entry.is_dir():
            shutil.rmtree(entry, ignore_errors=True)
        else:
            entry.unlink(missing_ok=True)


_told: set[str] = set()


def tell_no_cache(place: Path, error: OSError) -> None:
    """Log, once a process, that ``place`` cannot hold what was computed."""
    if not _told:
        logging.getLogger("agentface").warning(
            "nothing can be kept between runs (%s: %s): every start computes anew; "
            "set XDG_CACHE_HOME to a folder to write in",
            place,
            error.strerror or error,
        )
    _told.add(str(place))
