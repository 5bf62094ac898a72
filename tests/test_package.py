from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

import agentface

PROJECT = tomllib.loads((Path(__file__).parent.parent / "pyproject.toml").read_text())["project"]
HEAVY = (
    *("numba", "llvmlite", "scipy", "skfuzzy", "networkx", "trimesh", "moderngl", "glfw"),
    *("pygltflib", "PIL", "av", "click", "rich", "pythonosc", "pydantic", "yaml"),
)


def fresh(program: str) -> str:
    """What a program prints in an interpreter of its own."""
    run = subprocess.run([sys.executable, "-c", program], check=True, capture_output=True, text=True, timeout=240)
    return run.stdout.strip()


@pytest.mark.parametrize("statement", ["import agentface", "from agentface import AgentFaceError, FacePose"])
def test_importing_costs_about_numpy(statement):
    loaded = fresh(
        f"import sys; {statement}; print(*sorted({{name.partition('.')[0] for name in sys.modules}}))"
    ).split()
    assert "agentface" in loaded
    assert set(loaded) & set(HEAVY) == set()


def test_help_loads_no_heavy_library():
    program = "import sys; from agentface.cli import cli; cli(['--help'], standalone_mode=False); print(*sys.modules)"
    modules = fresh(program).split()
    assert "agentface.cli" in modules
    assert set(modules) & (set(HEAVY) - {"click"}) == set()


@pytest.mark.parametrize("name", agentface.__all__)
def test_public_name_resolves(name):
    assert getattr(agentface, name) is not None
    assert name in dir(agentface)


def test_public_names_are_told_to_type_checkers():
    assert set(agentface._HOMES) == set(agentface.__all__) - {"__version__"}


def test_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="no attribute 'Fase'"):
        agentface.Fase  # noqa: B018  # the access is what is tested


def test_version_is_that_of_the_project():
    assert agentface.__version__ == PROJECT["version"]


def test_changelog_knows_the_version():
    assert f"[{PROJECT['version']}]" in (Path(__file__).parent.parent / "CHANGELOG.md").read_text()
