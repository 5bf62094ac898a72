"""The text of shaders: files of ``shaders/`` with their includes in place, for OpenGL and for WebGL 2."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from agentface.errors import GraphicsError
from agentface.resources import data_folder

_INCLUDE = re.compile(r'^\s*#include\s+"([^"]+)"\s*$')
# Mesa: "2:13(5): error", NVIDIA: "2(13) : error", others: "ERROR: 2:13:"
_PLACE = re.compile(r"\b(\d+)(?::(\d+)(?:\(\d+\))?|\((\d+)\))\s*:")
_DESKTOP = "#version 330 core"
_ES = """#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp sampler3D;
precision highp sampler2DShadow;"""
"""GLSL ES 3.00, section 4.5.4: most samplers, and the floats of fragments, have no precision of their own."""


@dataclass(frozen=True, slots=True)
class ShaderSource:
    """One shader's text with its includes in place; ``files[n]`` is the file that ``#line`` calls ``n``."""

    text: str
    files: tuple[Path, ...]

    def explain(self, log: str) -> str:
        """A compiler's log with the numbers of files replaced by their paths."""

        def place(match: re.Match[str]) -> str:
            number = int(match[1])
            return f"{self.files[number]}:{match[2] or match[3]}:" if number < len(self.files) else match[0]

        return _PLACE.sub(place, log)


def read_source(name: str, folder: str | Path | None = None, defines: tuple[str, ...] = ()) -> ShaderSource:
    """The shader ``name`` from ``shaders/`` (or ``folder``); each ``#include "x.glsl"`` is put in once.

    ``defines`` are defined for the preprocessor behind the line ``#version``.

    Raises GraphicsError with file and line for a file that cannot be read.
    """
    folder = None if folder is None else Path(folder)
    root = folder or data_folder("shaders")
    files: list[Path] = []
    lines = _lines(root / name, files, "this shader")
    version = next((number for number, line in enumerate(lines, start=1) if line.startswith("#version")), 0)
    if defines:
        lines[version:version] = [*(f"#define {name}" for name in defines), f"#line {version + 1} 0"]
    return ShaderSource("\n".join(lines) + "\n", tuple(files))


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


def embedded(source: ShaderSource) -> str:
    """The same shader in GLSL ES 3.00, as WebGL 2 takes it.

    All that is written in ``shaders/`` is common to both languages, but for the version, the precisions and the lines
    ``#line``, whose files a browser does not know. Raises GraphicsError for a shader of another version.
    """
    first, *lines = source.text.splitlines()
    if first != _DESKTOP:
        raise GraphicsError(f"{source.files[0]}:1: expected {_DESKTOP}, got: {first}")
    return "\n".join([_ES, *(line for line in lines if line and not line.startswith("#line"))]) + "\n"
