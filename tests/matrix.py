"""Runs the tests on every Python that is found, and once with the lowest versions that pyproject.toml declares.

    python tests/matrix.py [--only 3.12 | --only lowest] [pytest's own arguments]

Each run has a virtual environment in out/matrix/. A Python that is missing is named and is no failure.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "out" / "matrix"
VERSIONS = ("3.11", "3.12", "3.13", "3.14")
UNDECLARED = ("3.14",)
"""Tried although pyproject.toml does not say that they work."""
LOWEST = "lowest"


def lowest(project: dict) -> list[str]:
    """``name==version`` for the lower bound of every dependency, those of the extras included."""
    from packaging.requirements import Requirement

    texts = [*project["dependencies"], *(text for extra in project["optional-dependencies"].values() for text in extra)]
    pins = {}
    for requirement in map(Requirement, texts):
        bounds = [clause.version for clause in requirement.specifier if clause.operator in (">=", "==", "~=")]
        if len(bounds) != 1:
            raise SystemExit(f"pyproject.toml: expected one lower bound, got {requirement}")
        pins[requirement.name] = f"{requirement.name}=={bounds[0]}"
    return list(pins.values())


def python_of(version: str) -> str | None:
    """The command of a Python that runs, on the PATH or among those of pyenv and uv, or None.

    A version manager may have a ``python3.x`` on the PATH that does nothing but say so.
    """
    homes = (
        Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions",
        Path(os.environ.get("UV_PYTHON_INSTALL_DIR", Path.home() / ".local/share/uv/python")),
    )
    kept = [str(path) for home in homes for path in sorted(home.glob(f"*{version}.*/bin/python{version}"))]
    for command in (f"python{version}", *reversed(kept)):
        try:
            done = subprocess.run(
                [command, "-c", "import ensurepip, venv"], check=False, capture_output=True, timeout=60
            )
        except OSError:
            continue
        if done.returncode == 0:
            return command
    return None


def make(name: str, python: str) -> Path:
    """A virtual environment with the project; its Python."""
    folder = FOLDER / name
    inside = folder / "bin" / "python"
    subprocess.run([python, "-m", "venv", "--clear", folder], check=True)
    environment = os.environ | {"PIP_QUIET": "2"}
    if name in UNDECLARED:  # elsewhere pip would take what is for newer Pythons
        environment["PIP_IGNORE_REQUIRES_PYTHON"] = "1"
    constraints: list[str] = []
    group = "dev"
    if name == LOWEST:
        group = "test"  # what makes the documents needs newer ones
        path = folder / "lowest.txt"
        project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
        path.write_text("\n".join(lowest(project)) + "\n")
        constraints = ["--constraint", str(path)]
    for words in (
        ["--upgrade", "pip>=25.1"],
        [*constraints, "--editable", f"{ROOT}[window,speech,sound]", "--group", group],
    ):
        subprocess.run([inside, "-m", "pip", "install", *words], check=True, env=environment, cwd=ROOT)
    return inside


def main(arguments: list[str]) -> int:
    only = None
    if arguments[:1] == ["--only"]:
        only, arguments = arguments[1], arguments[2:]
    results = {}
    for name in (*VERSIONS, LOWEST):
        if only not in (None, name):
            continue
        python = python_of(VERSIONS[0] if name == LOWEST else name)
        if python is None:
            results[name] = "missing on this machine"
            continue
        print(f"== {name}", flush=True)
        try:
            inside = make(name, python)
        except subprocess.CalledProcessError as error:
            results[name] = f"FAILED: {' '.join(map(str, error.cmd[2:5]))} ... returned {error.returncode}"
            continue
        strict = os.environ | ({} if name == LOWEST else {"AGENTFACE_REQUIRE_TOOLS": "1"})
        done = subprocess.run([inside, "-m", "pytest", "-q", *arguments], check=False, cwd=ROOT, env=strict)
        results[name] = f"FAILED: pytest returned {done.returncode}" if done.returncode else "passed"
    print(*(f"{name:8} {result}" for name, result in results.items()), sep="\n")
    return any(result.startswith("FAILED") for result in results.values())


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
