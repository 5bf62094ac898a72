"""Which OpenGL context is the current one of this thread: other programs have contexts of their own, and keep them.

Sources: Khronos, EGL 1.5, section 3.7 (eglMakeCurrent, eglQueryAPI); OpenGL Graphics with the X Window System 1.4,
section 3.3.7. A thread has one current context, made so through either of them; through libglvnd, one of EGL can only
become current when that of GLX was let go, and the other way round.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any, NamedTuple

_Handle = ctypes.c_void_p
_EGL_DRAW, _EGL_READ = 0x3059, 0x305A


class Current(NamedTuple):
    """A context and what it draws into and reads from; ``api`` is ``egl`` or ``glx``."""

    api: str
    context: int
    display: int | None
    draw: int | None
    read: int | None


def current_context() -> Current | None:
    """The current context of this thread, None where it has none."""
    if (egl := _egl()) is not None and (context := egl.context()):
        return Current("egl", context, egl.display(), egl.surface(_EGL_DRAW), egl.surface(_EGL_READ))
    if (glx := _glx()) is not None and (context := glx.context()):
        return Current("glx", context, glx.display(), glx.draw(), glx.read())
    return None


def make_current(wanted: Current | None) -> None:
    """Make a context current that was so before, or let go of the one that is."""
    now = current_context()
    if now == wanted:
        return
    if now is not None and (wanted is None or now.api != wanted.api):
        _make(now._replace(context=0, draw=0, read=0))
    if wanted is not None:
        _make(wanted)


@contextmanager
def kept_current() -> Iterator[None]:
    """Whatever becomes current in the block, afterwards the context is that was so before."""
    before = current_context()
    try:
        yield
    finally:
        make_current(before)


@contextmanager
def kept_api() -> Iterator[None]:
    """The API of which EGL makes contexts in this thread is afterwards the one that it was."""
    egl = _egl()
    before = egl.query_api() if egl is not None else None
    try:
        yield
    finally:
        if egl is not None and before:
            egl.bind_api(before)


def _make(wanted: Current) -> None:
    if wanted.api == "egl" and (egl := _egl()) is not None:
        egl.make(wanted.display, wanted.draw, wanted.read, wanted.context)
    elif (glx := _glx()) is not None:
        glx.make(wanted.display, wanted.draw or 0, wanted.read or 0, wanted.context)


class _Egl(NamedTuple):
    context: Callable[[], int | None]
    display: Callable[[], int | None]
    surface: Callable[[int], int | None]
    make: Callable[..., int]
    query_api: Callable[[], int]
    bind_api: Callable[[int], int]


class _Glx(NamedTuple):
    context: Callable[[], int | None]
    display: Callable[[], int | None]
    draw: Callable[[], int]
    read: Callable[[], int]
    make: Callable[..., int]


@cache
def _egl() -> _Egl | None:
    library = _library("libEGL.so.1")
    if library is None:
        return None
    return _Egl(
        _function(library, "eglGetCurrentContext", _Handle),
        _function(library, "eglGetCurrentDisplay", _Handle),
        _function(library, "eglGetCurrentSurface", _Handle, ctypes.c_int),
        _function(library, "eglMakeCurrent", ctypes.c_uint, _Handle, _Handle, _Handle, _Handle),
        _function(library, "eglQueryAPI", ctypes.c_uint),
        _function(library, "eglBindAPI", ctypes.c_uint, ctypes.c_uint),
    )


@cache
def _glx() -> _Glx | None:
    library = _library("libGL.so.1")
    if library is None or not hasattr(library, "glXGetCurrentContext"):
        return None
    return _Glx(
        _function(library, "glXGetCurrentContext", _Handle),
        _function(library, "glXGetCurrentDisplay", _Handle),
        _function(library, "glXGetCurrentDrawable", ctypes.c_ulong),
        _function(library, "glXGetCurrentReadDrawable", ctypes.c_ulong),
        _function(library, "glXMakeContextCurrent", ctypes.c_int, _Handle, ctypes.c_ulong, ctypes.c_ulong, _Handle),
    )


def _library(name: str) -> ctypes.CDLL | None:
    try:
        return ctypes.CDLL(name)
    except OSError:  # then no context of it is current
        return None


def _function(library: ctypes.CDLL, name: str, result: Any, *arguments: Any) -> Any:
    function = getattr(library, name)
    function.restype, function.argtypes = result, arguments
    return function
