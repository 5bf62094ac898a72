"""Imports run one way: a part knows what stands before it, and neither its siblings nor what is built on it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import agentface

PACKAGE = Path(agentface.__file__).parent

LAYERS = (
    ("errors",),
    ("conventions", "named_array", "resources", "config", "cache"),
    ("parameters", "clock", "kernel"),
    ("mesh",),
    ("head",),
    ("emotion", "motion", "deform", "tissue", "mpeg4"),
    ("requests",),
    ("face",),
    ("live",),
    ("io", "view"),
    ("window",),
    ("studies",),
    ("commands",),
    ("cli",),
    ("__main__",),
)
RANK = {part: rank for rank, layer in enumerate(LAYERS) for part in layer}

EXCEPTIONS = {
    ("motion", "emotion"): "the emotion channel fades between contractions, which the fuzzy rules infer",
    ("face", "view"): "Face.render() opens a renderer when it is first called",
}

# Libraries that touch the world outside, and the only parts that may know each
OWNERS = {
    "moderngl": {"view", "window"},
    "glfw": {"window"},
    "imgui_bundle": {"window"},
    "socket": {"io"},
    "pythonosc": {"io"},
    "av": {"io"},
    "defusedxml": {"io"},
    "PIL": {"head", "io", "view", "studies"},
}


@cache
def imports() -> list[tuple[str, str, str]]:
    """Every import at any depth as (part, imported module, file:line); the package's own __init__ re-exports."""
    return list(_imports())


def _imports() -> Iterator[tuple[str, str, str]]:
    for path in PACKAGE.rglob("*.py"):
        part = path.relative_to(PACKAGE).parts[0].removesuffix(".py")
        if part == "__init__":
            continue
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                assert not node.level, f"{path}:{node.lineno}: expected an absolute import"
                modules = [f"{node.module}.{alias.name}" for alias in node.names]
            elif isinstance(node, ast.Import):
                modules = [alias.name for alias in node.names]
            else:
                continue
            for module in modules:
                yield part, module, f"{path.relative_to(PACKAGE.parent)}:{node.lineno}"


def inner_imports() -> Iterator[tuple[str, str, str]]:
    """The imports of one part of agentface by another: (part, other part, file:line)."""
    for part, module, place in imports():
        root, _, rest = module.partition(".")
        other = rest.partition(".")[0]
        if root == "agentface" and other != part:
            yield part, other, place


def test_every_part_has_a_layer():
    parts = {
        path.name.removesuffix(".py") for path in PACKAGE.iterdir() if path.suffix == ".py" or any(path.glob("*.py"))
    }
    assert parts - {"__init__"} <= RANK.keys()


def test_parts_import_only_what_stands_before_them():
    wrong = [
        f"{place}: {part} imports {other}"
        for part, other, place in inner_imports()
        if RANK[other] >= RANK[part] and (part, other) not in EXCEPTIONS
    ]
    assert not wrong, "\n".join(wrong)


def test_no_exception_is_left_over():
    assert {(part, other) for part, other, _ in inner_imports()} >= EXCEPTIONS.keys()


@pytest.mark.parametrize("library", OWNERS)
def test_only_its_owners_know_a_library(library):
    parts = {part for part, module, _ in imports() if module.partition(".")[0] == library}
    assert parts == OWNERS[library]
