"""What becomes of a window whose display goes away: X11's library then ends the program, whatever it was doing."""

from __future__ import annotations

import ctypes
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_HANDLER = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)


@contextmanager
def display_watched(last: Callable[[], object]) -> Iterator[None]:
    """In the block, call ``last`` before the program ends, with code 1, because the connection to X11 is lost."""
    try:
        library = ctypes.CDLL("libX11.so.6")
        set_handler = library.XSetIOErrorHandler
    except (OSError, AttributeError):  # a desktop without X11
        yield
        return
    set_handler.restype = ctypes.c_void_p
    set_handler.argtypes = [ctypes.c_void_p]

    def lost(_display: int | None) -> int:
        try:
            last()
        finally:
            os._exit(1)

    handler = _HANDLER(lost)
    before = set_handler(ctypes.cast(handler, ctypes.c_void_p))
    try:
        yield
    finally:
        set_handler(before)
