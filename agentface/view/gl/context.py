"""An OpenGL context without a window, and programs compiled from ``shaders/``."""

from __future__ import annotations

import ctypes
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, NoReturn

from agentface.errors import GraphicsError
from agentface.resources import data_folder
from agentface.view.gl.current import kept_api
from agentface.view.gl.source import ShaderSource, read_source

_TITLE = re.compile(r"\AGLSL \w+ failed\s+\w+\s+=+\s+")

_NO_EGL = """expected OpenGL 3.3 through EGL, got: {reason}.
On Debian and Ubuntu install the Debian packages libegl1 and libgl1 (Mesa's software renderer comes with them):
    apt-get install --no-install-recommends libegl1 libgl1
Everything that makes no picture works without them."""

_NO_PACKAGE = """expected the Python packages moderngl and glcontext, got: {reason}.
Install agentface with what it needs:  pip install --force-reinstall agentface"""

# What moderngl calls errors that it does not know is, of those there are, GL_CONTEXT_LOST.
_LOST = {"GL_OUT_OF_MEMORY": "out of memory", "GL_UNKNOWN_ERROR": "the driver was reset"}
_KNOWN = b"\xff\x00\xff\xff"


def open_context() -> Any:
    """A headless ``moderngl.Context`` (OpenGL 3.3 core, through EGL).

    It is left current. Raises GraphicsError that names the system's packages to install when the machine has no OpenGL,
    or the Python package that does not load.
    """
    try:
        import moderngl

        import_module("glcontext.egl")
    except ImportError as error:
        raise GraphicsError(_NO_PACKAGE.format(reason=error)) from error
    store = getattr(moderngl, "_store", None)
    default = getattr(store, "default_context", None)  # what moderngl.get_context() gives the program that we are in
    try:
        settings: Any = {"standalone": True, "backend": "egl", "require": 330}
        with kept_api():
            return moderngl.create_context(**settings)
    except Exception as error:  # the loader raises whatever the system's libraries gave it
        raise GraphicsError(_NO_EGL.format(reason=str(error).strip() or type(error).__name__)) from error
    finally:
        if store is not None:
            store.default_context = default


@cache
def _finish() -> Callable[[], object] | None:
    try:
        finish: Callable[[], object] = ctypes.CDLL("libGL.so.1").glFinish
    except (OSError, AttributeError):
        return None
    return finish


def finish(context: Any) -> None:
    """Wait until everything is drawn in ``context``, the current one; other threads of Python run meanwhile.

    moderngl's own calls keep them waiting.
    """
    wait = _finish()
    (wait or context.finish)()


class LostContextCheck:
    """One pixel of a known colour. With the context lost, reading a picture gives what lay in memory, and no error."""

    def __init__(self, context: Any) -> None:
        self._context = context
        self._pixel = context.framebuffer([context.renderbuffer((1, 1), 4)])
        self._pixel.clear(1.0, 0.0, 1.0, 1.0)

    def check(self) -> None:
        """Raise GraphicsError when what was drawn until now is lost."""
        seen = bytearray(4)
        self._pixel.read_into(seen, components=4, alignment=1)
        reason = "" if seen == _KNOWN else "the driver lost its context"
        reason = _LOST.get(self._context.error, reason)
        if reason:
            raise GraphicsError(
                f"the picture: expected OpenGL to have drawn it, got: {reason};"
                " ask for a smaller picture, or start the program again"
            )


@contextmanager
def shader_names() -> Iterator[None]:
    """Raise GraphicsError for a uniform or an attribute that is set here and that its shader does not use."""
    try:
        yield
    except KeyError as error:
        trace = error.__traceback__
        while trace is not None and trace.tb_next is not None:
            trace = trace.tb_next
        if trace is None or trace.tb_frame.f_globals["__name__"] != "moderngl":
            raise
        raise GraphicsError(
            f"the shaders in {data_folder('shaders')}: expected {error} to be declared and used in one, got none;"
            " a compiler drops what has no effect on the picture"
        ) from error


def compile_program(
    context: Any, vertex: str, fragment: str | None, folder: str | Path | None = None, defines: tuple[str, ...] = ()
) -> Any:
    """The ``moderngl.Program`` of two files of ``shaders/``; without ``fragment`` it writes depth only.

    Raises GraphicsError with the compiler's messages, each with its file and line.
    """
    folder = None if folder is None else Path(folder)
    import moderngl

    sources = [read_source(vertex, folder, defines)]
    if fragment is not None:
        sources.append(read_source(fragment, folder, defines))
    try:
        return context.program(
            vertex_shader=sources[0].text,
            fragment_shader=sources[1].text if fragment else "#version 330 core\nvoid main() {}\n",
        )
    except moderngl.Error as error:
        _explain(str(error), vertex, fragment, sources)


def _explain(log: str, vertex: str, fragment: str | None, sources: list[ShaderSource]) -> NoReturn:
    source = sources[-1] if "fragment_shader" in log else sources[0]
    names = vertex if fragment is None else f"{vertex} and {fragment}"
    said = source.explain(_TITLE.sub("", log)).strip()
    raise GraphicsError(f"the shaders {names}: expected them to compile, got:\n{said}")
