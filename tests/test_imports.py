"""Imports run one way: a part knows what stands before it, and neither its siblings nor what is built on it."""

from __future__ import annotations

import ast
from collections import defaultdict
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
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
    ("emotion", "deform", "facs", "speech"),
    ("tissue", "mpeg4"),
    ("motion",),
    ("arkit", "bml"),
    ("vrm",),
    ("requests",),
    ("view", "talk"),
    ("events", "calls"),
    ("face",),
    ("live",),
    ("io",),
    ("window", "agents"),
    ("studies",),
    ("commands",),
    ("cli",),
    ("__main__",),
)
RANK = {part: rank for rank, layer in enumerate(LAYERS) for part in layer}

# Libraries that touch the world outside, and the only parts that may know each
OWNERS = {
    "moderngl": {"view", "window"},
    "glfw": {"window"},
    "imgui_bundle": {"window"},
    "socket": {"io"},
    "pythonosc": {"io"},
    "av": {"io"},
    "miniaudio": {"io"},
    "pocketsphinx": {"speech"},
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
    wrong = [f"{place}: {part} imports {other}" for part, other, place in inner_imports() if RANK[other] >= RANK[part]]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("library", OWNERS)
def test_only_its_owners_know_a_library(library):
    parts = {part for part, module, _ in imports() if module.partition(".")[0] == library}
    assert parts == OWNERS[library]


MODULES = {
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__"): path
    for path in PACKAGE.rglob("*.py")
}


@cache
def module_graph() -> dict[str, set[str]]:
    """The modules of the package that each module imports, at any depth of its text, for type checkers too."""
    graph: dict[str, set[str]] = {module: set() for module in MODULES}
    for module, path in MODULES.items():
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.ImportFrom):
                names = [f"{node.module}.{alias.name}" for alias in node.names]
                graph[module] |= {name if name in MODULES else str(node.module) for name in names}
            elif isinstance(node, ast.Import):
                graph[module] |= {alias.name for alias in node.names}
        graph[module] = (graph[module] & MODULES.keys()) - {module}
    return graph


def room(module: str) -> str:
    """The folder that a module lies in. In a folder that has rooms, a module beside them is a room of its own."""
    folder = MODULES[module].parent
    if MODULES[module].stem == "__init__" or not any(folder.glob("*/*.py")):
        return str(folder.relative_to(PACKAGE.parent))
    return str(MODULES[module].relative_to(PACKAGE.parent).with_suffix(""))


def circle(graph: dict[str, set[str]]) -> list[str]:
    """Some circle of a graph, or nothing."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def test_a_circle_is_found():
    assert circle({"a": {"b"}, "b": {"c"}, "c": set(), "d": {"a", "c"}}) == []
    assert set(circle({"a": {"b"}, "b": {"c"}, "c": {"a"}, "d": {"a"}})) == {"a", "b", "c"}


def test_no_module_needs_itself():
    assert circle(module_graph()) == []


def test_rooms_inside_parts_need_each_other_one_way():
    graph: dict[str, set[str]] = defaultdict(set)
    for module, others in module_graph().items():
        graph[room(module)] |= {room(other) for other in others} - {room(module)}
    assert {"agentface/deform/mouth", "agentface/view/gl", "agentface/window/panel", "agentface/face"} <= graph.keys()
    assert circle(graph) == []


def test_no_two_public_classes_share_a_name():
    places = defaultdict(list)
    for module, path in MODULES.items():
        for node in ast.parse(path.read_text()).body:
            if isinstance(node, ast.ClassDef) and not node.name.startswith("_"):
                places[node.name].append(module)
    assert {name: modules for name, modules in places.items() if len(modules) > 1} == {}
