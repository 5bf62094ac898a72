"""Compiled loops: numba's ``njit`` with a cache that no edit makes stale and that no disk can break.

numba's own cache looks at the file of a function and at nothing that the function reads from other files. Here the
folder of the cache bears a stamp of the package's sources instead, in the user's cache folder. Where nothing can be
written there, kernels are compiled anew in every process, and a log says so once.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import FunctionType
from typing import Any, TypeVar

from agentface.cache import tell_no_cache, version_folder

_F = TypeVar("_F", bound=Callable[..., Any])
_PACKAGE = Path(__file__).parent
_READS: dict[str, tuple[str, ...]] = {
    "mesh": (),
    "emotion": (),
    "speech": (),
    "deform": ("mesh",),
    "tissue": ("mesh", "deform"),
    "mpeg4": ("mesh", "deform", "emotion", "speech"),
    "motion": ("mesh", "deform", "emotion", "speech", "mpeg4"),
}
"""The rooms that have kernels, and the others that each of them reads: an edit elsewhere leaves its kernels good."""
_ABOVE = {"__init__.py", "__main__.py", "cli.py", "face.py"}
"""Modules of the package itself that no room reads."""


def can_compile() -> bool:
    """Whether numba may compile: a user can forbid it with ``NUMBA_DISABLE_JIT=1``, and gets the numpy forms."""
    if "numba" in sys.modules:
        return not sys.modules["numba"].config.DISABLE_JIT
    return os.environ.get("NUMBA_DISABLE_JIT", "0") in ("", "0")


def any_kept(room: str = "deform") -> bool:
    """Whether kernels of a room's sources have been kept on this machine: without any, who first needs them waits."""
    folder = _folder(room)
    return folder is not None and any(folder.rglob("*.nbi"))


def kernel(**options: Any) -> Callable[[_F], _F]:
    """``numba.njit(**options)`` for a decorator's use; the machine code outlives the process where it can."""
    from numba import njit

    def compile_later(function: _F) -> _F:
        folder = _folder(_room_of(function))
        with _cached_in(folder):
            compiled = njit(cache=folder is not None, nogil=True, **options)(function)
        return _careful(compiled) if folder is not None else compiled

    return compile_later


def compiled_twin(function: Callable[..., Any], module: dict[str, Any], **options: Any) -> Any:
    """The kernel that runs the code of ``function`` with the names of ``module``, a ``globals()``, in place of its own.

    So an order of calls is written once: the names that stand for numpy forms where it is written stand for their
    compiled twins in ``module``.
    """
    twin = FunctionType(function.__code__, module, function.__name__, function.__defaults__)
    twin.__module__ = module["__name__"]
    return kernel(**options)(twin)


def _room_of(function: Callable[..., Any]) -> str:
    """The room of the module that a kernel is written in; the empty name for one that is none of ours."""
    room = f"{function.__module__}..".split(".")[1]
    return room if room in _READS else ""


@cache
def _folder(room: str) -> Path | None:
    """Where this version's kernels of a room are kept, or None where nothing can be."""
    from numba import __version__ as numba_version

    return version_folder(f"kernels/{room}", _sources(room), numba_version) if can_compile() else None


def _sources(room: str) -> Iterator[Path]:
    """What kernels of a room are made of; those of another package, of all rooms."""
    yield from sorted(path for path in _PACKAGE.glob("*.py") if path.name not in _ABOVE)
    for read in sorted((*_READS[room], room) if room else _READS):
        yield from sorted((_PACKAGE / read).rglob("*.py"))


@contextmanager
def _cached_in(folder: Path | None) -> Iterator[None]:
    import numba

    config: Any = numba.config
    before = config.CACHE_DIR
    try:
        if folder is not None:
            config.CACHE_DIR = str(folder)
        yield
    finally:
        config.CACHE_DIR = before


def _careful(compiled: Any) -> Any:
    """``compiled``, which goes on when its machine code cannot be kept: numba itself raises on a full disk."""
    store = compiled._cache  # noqa: SLF001  # numba has no other way to reach it
    save = store.save_overload

    def save_if_possible(signature: Any, data: Any) -> None:
        try:
            save(signature, data)
        except OSError as error:
            tell_no_cache(Path(store.cache_path), error)

    store.save_overload = save_if_possible
    return compiled
