"""An OpenGL context without a window, and programs compiled from ``shaders/``."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

from agentface.errors import GraphicsError
from agentface.resources import data_folder

_INCLUDE = re.compile(r'^\s*#include\s+"([^"]+)"\s*$')
# Mesa: "2:13(5): error", NVIDIA: "2(13) : error", others: "ERROR: 2:13:"
_PLACE = re.compile(r"\b(\d+)(?::(\d+)(?:\(\d+\))?|\((\d+)\))\s*:")

_NO_EGL = """expected OpenGL 3.3 through EGL, got: {reason}.
On Debian and Ubuntu install the Debian packages libegl1 and libgl1 (Mesa's software renderer comes with them):
    apt-get install --no-install-recommends libegl1 libgl1
Everything that makes no picture works without them."""


def open_context() -> Any:
    """A headless ``moderngl.Context`` (OpenGL 3.3 core, through EGL).

    Raises GraphicsError, naming the packages to install, when the machine has no OpenGL.
    """
    import moderngl

    try:
        settings: Any = {"standalone": True, "backend": "egl", "require": 330}
        return moderngl.create_context(**settings)
    except Exception as error:  # the loader raises whatever the system's libraries gave it
        raise GraphicsError(_NO_EGL.format(reason=str(error).strip() or type(error).__name__)) from error


def check_alive(context: Any) -> None:
    """Raise GraphicsError when what was drawn is lost: then reading it gives whatever lay in memory, and no error."""
    error = context.error
    if error != "GL_NO_ERROR" or not context.info["GL_RENDERER"]:
        reason = error if error != "GL_NO_ERROR" else "no context, or another one's"
        raise GraphicsError(
            f"the picture: expected OpenGL to have drawn it, got: {reason}."
            " The driver was reset or ran out of memory; draw in a smaller size, or start again"
        )


@dataclass(frozen=True, slots=True)
class Source:
    """One shader's text with its includes in place; ``files[n]`` is the file that ``#line`` calls ``n``."""

    text: str
    files: tuple[Path, ...]

    def explain(self, log: str) -> str:
        """A compiler's log with the numbers of files replaced by their paths."""

        def place(match: re.Match[str]) -> str:
            number = int(match[1])
            return f"{self.files[number]}:{match[2] or match[3]}:" if number < len(self.files) else match[0]

        return _PLACE.sub(place, log)


def read_source(name: str, folder: Path | None = None) -> Source:
    """The shader ``name`` from ``shaders/`` (or ``folder``); each ``#include "x.glsl"`` is put in once.

    Raises GraphicsError with file and line for a file that cannot be read.
    """
    root = folder or data_folder("shaders")
    files: list[Path] = []
    return Source("\n".join(_lines(root / name, files, "this shader")) + "\n", tuple(files))


def _lines(path: Path, files: list[Path], wanted_by: str) -> list[str]:
    try:
        text = path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise GraphicsError(f"{wanted_by}: expected a readable shader {path}, got: {error}") from error
    number = len(files)
    files.append(path)
    lines: list[str] = []
    for count, line in enumerate(text.splitlines(), start=1):
        match = _INCLUDE.match(line)
        if match is None:
            lines.append(line)
        elif path.parent / match[1] not in files:
            lines += ["#line 1 " + str(len(files)), *_lines(path.parent / match[1], files, f"{path}:{count}")]
            lines.append(f"#line {count + 1} {number}")
        else:
            lines.append("")
    return lines


def compile_program(context: Any, vertex: str, fragment: str | None, folder: Path | None = None) -> Any:
    """The ``moderngl.Program`` of two files of ``shaders/``; without ``fragment`` it writes depth only.

    Raises GraphicsError with the compiler's messages, each with its file and line.
    """
    import moderngl

    sources = [read_source(vertex, folder)]
    if fragment is not None:
        sources.append(read_source(fragment, folder))
    try:
        return context.program(
            vertex_shader=sources[0].text,
            fragment_shader=sources[1].text if fragment else "#version 330 core\nvoid main() {}\n",
        )
    except moderngl.Error as error:
        _explain(str(error), vertex, fragment, sources)


def _explain(log: str, vertex: str, fragment: str | None, sources: list[Source]) -> NoReturn:
    source = sources[-1] if "fragment_shader" in log else sources[0]
    names = vertex if fragment is None else f"{vertex} and {fragment}"
    raise GraphicsError(f"the shaders {names} do not compile:\n{source.explain(log).strip()}")
