"""The house rules that no tool checks: short files, short functions, links that lead somewhere."""

from __future__ import annotations

import ast
import re
from pathlib import Path
from statistics import median
from typing import Any

import pytest

import agentface
from tests.slow import SlowTests

ROOT = Path(__file__).parent.parent
SOURCES = sorted(Path(agentface.__file__).parent.rglob("*.py"))
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "docs").glob("*.md"))]


def length(path: Path) -> int:
    return path.read_text().count("\n")


def test_files_are_short():
    assert median(map(length, SOURCES)) < 180
    assert [path.name for path in [*SOURCES, *Path(__file__).parent.rglob("*.py")] if length(path) > 600] == []


def test_functions_fit_a_screen():
    long = [
        f"{path}:{node.lineno}: {node.name}"
        for path in SOURCES
        for node in ast.walk(ast.parse(path.read_text()))
        if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)
        if (node.end_lineno or 0) - node.lineno >= 60
    ]
    assert long == []


def test_data_folders_hold_no_code():
    assert [path for folder in ("regions", "rules", "shaders") for path in (ROOT / folder).rglob("*.py")] == []


def linked(page: Path) -> list[Path]:
    """What a page links to in the project."""
    targets = re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text())
    return [(page.parent / target).resolve() for target in targets if "://" not in target]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page):
    assert [target for target in linked(page) if not target.exists()] == []


def test_readme_leads_to_every_page():
    found, new = set(), {PAGES[0].resolve()}
    while new:
        found |= new
        new = {target for page in new for target in linked(page) if target.suffix == ".md"} - found
    assert {page.resolve() for page in PAGES} <= found


@pytest.mark.gl
def test_the_readme_s_first_program_runs():
    program = re.findall(r"```python\n(.*?)```", PAGES[0].read_text(), re.DOTALL)[0]
    known: dict[str, Any] = {}
    exec(program, known)  # noqa: S102  # the project's own words
    assert known["image"].shape == (720, 1280, 3)
    assert known["face"].emotion["happiness"] == pytest.approx(0.8)


def test_what_is_noted_as_slow_is_there():
    def is_there(name: str) -> bool:
        module, *within = name.split("::")
        path = ROOT / module
        return path.exists() and (not within or f"def {within[-1]}(" in path.read_text())

    assert [name for name in SlowTests.noted().names if not is_there(name)] == []


def test_what_takes_long_is_noted_and_what_did_not_run_stays():
    noted = SlowTests(frozenset({"a.py::test_gone", "b.py", "c.py::test_long"}))
    reports = [
        ("a.py::test_short[1]", "call", 0.1),
        ("a.py::test_many[1]", "call", 0.1),
        *((f"a.py::test_many[{n}]", "call", 0.1) for n in range(2, 8)),
        ("a.py::test_long[1]", "call", 2.0),
        ("a.py::test_short[1]", "setup", 0.1),
        ("d.py::test_ready", "setup", 2.0),
        ("d.py::test_ready", "call", 2.0),
    ]
    slow = SlowTests.measured(reports, noted)
    assert slow.names == {"a.py::test_many", "a.py::test_long", "b.py", "c.py::test_long", "d.py"}
    assert slow.has("a.py::test_long[7]")
    assert slow.has("d.py::test_other")
    assert not slow.has("a.py::test_short[1]")
