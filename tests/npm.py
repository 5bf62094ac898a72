"""Packages of npm that tests run, each of one version, kept in the user's cache folder."""

from __future__ import annotations

import os
import subprocess
import tempfile
from pathlib import Path

import pytest

from agentface.cache import cache_folder
from tests import tools


def node_modules(name: str, version: str, *beside: str) -> Path:
    """The ``node_modules`` folder with this package, fetched from the registry when it is not there yet.

    ``beside`` are others that it works with, as ``name@version``.

    Where it cannot be had, the test is skipped, which AGENTFACE_REQUIRE_TOOLS=1 makes a failure.
    """
    cache = cache_folder()
    assert cache is not None, "tests run in a home folder"
    folder = cache / "tests" / "-".join([name, version, *beside]).replace("/", "_")
    modules = folder / "node_modules"
    if not (modules / name / "package.json").is_file():
        tools.require("npm")
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent) as temporary:
            fresh = Path(temporary) / "fresh"
            fresh.mkdir()
            command = ["npm", "install", "--no-audit", "--no-fund", "--ignore-scripts", "--prefix", fresh]
            run = subprocess.run(
                [*command, f"{name}@{version}", *beside],
                cwd=fresh,
                capture_output=True,
                text=True,
                timeout=200,
                check=False,
            )
            if run.returncode:
                pytest.skip(f"npm could not fetch {name} {version}: {run.stderr}")
            try:
                os.rename(fresh, folder)  # noqa: PTH104  # unlike Path.replace, never over a folder that is in use
            except OSError:
                if not modules.is_dir():  # otherwise another process was quicker
                    raise
    return modules
