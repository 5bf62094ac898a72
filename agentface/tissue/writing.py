"""Writes ``tissue.yaml``, laid out as the anatomist's table and with its comments."""

from __future__ import annotations

from typing import Any

from agentface.tissue.reading import anatomy_file
from agentface.tissue.tissue_file import TissueFile

_TITLE = """\
# The soft tissue of this face. `agentface calibrate FACE --deformer tissue` fits the muscles to the artists' shapes of
# this face and keeps everything else, which the anatomist's table, regions/tissue.yaml, began with.
"""
_FIRST = ("kind", "origin", "insertion", "centre", "regions", "not_regions", "fade")
_LAST = ("strength", "moved_by", "action_unit")
"""The keys of a muscle that all others stand between."""
_WIDTH = 118
_INDENT = 2


def tissue_yaml(file: TissueFile) -> str:
    """The text of ``tissue.yaml``; read again, it gives the same file. What has its default value is left out."""
    content = file.model_dump(exclude_defaults=True)
    content["skull"] = file.skull.model_dump()  # with the three that a user turns
    content["muscles"] = {name: dict(sorted(row.items(), key=_rank)) for name, row in content["muscles"].items()}
    about, comments = _comments()
    lines = [_TITLE + about]
    for key, value in content.items():
        lines += ["", *comments.get(key, ()), *_lines(key, value, 0)]
    return "\n".join(lines) + "\n"


def _rank(item: tuple[str, Any]) -> int:
    """Where a key of a muscle stands; those of its kind in the middle, as they are."""
    key = item[0]
    if key in _FIRST:
        return _FIRST.index(key)
    return len(_FIRST) + (1 + _LAST.index(key) if key in _LAST else 0)


def _comments() -> tuple[str, dict[str, list[str]]]:
    """What the anatomist's table says of all of itself, without its title; and, by key, above each of its sections."""
    first, *blocks = anatomy_file().read_text(encoding="utf-8").split("\n\n")
    sections = {}
    for block in blocks:
        above = [line for line in block.splitlines() if line.startswith("#")]
        key = next((line.partition(":")[0] for line in block.splitlines() if not line.startswith("#")), "")
        sections[key] = above
    return "#\n" + first.partition("\n#\n")[2], sections


def _lines(key: str, value: Any, depth: int) -> list[str]:
    """A key and its value, on one line unless it is too long or a table of tables."""
    start = " " * _INDENT * depth + f"{key}:"
    line = f"{start} {_flow(value)}"
    if not isinstance(value, dict) or not value:
        return [line]
    if len(line) <= _WIDTH and not any(isinstance(inner, dict) for inner in value.values()):
        return [line]
    return [start, *(line for name, inner in value.items() for line in _lines(name, inner, depth + 1))]


def _flow(value: Any) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {_flow(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_flow, value)) + "]"
    return str(value)
