"""Programs that tests need beside Python, and what happens where they are missing.

Without one of them a test is skipped, so that a developer without a virtual display can still run the others. With
AGENTFACE_REQUIRE_TOOLS=1 in the environment, as under ``make test``, every skip is a failure.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Generator
from pathlib import Path

import pytest

import agentface

PACKAGES = {
    "xvfb-run": "xvfb",
    "xauth": "xauth",
    "xdotool": "xdotool",
    "xprop": "x11-utils",
    "oscsend": "liblo-tools",
    "oscdump": "liblo-tools",
    "node": "nodejs",
    "npm": "npm",
    "flite": "flite",
    "chromium": "chromium",
    "blender": "blender",
}
"""The Debian packages in which the programs are; the Makefile installs them."""
LIBRARIES = {"libespeak-ng.so.1": "libespeak-ng1"}
"""Likewise the libraries."""


PAGE = Path(agentface.__file__).parent / "io" / "web" / "page" / "dist"


def strict() -> bool:
    """Whether a skip is a failure."""
    return os.environ.get("AGENTFACE_REQUIRE_TOOLS") == "1"


def require(*programs: str) -> None:
    """Go on only where all ``programs`` are on the PATH: else skip the test, or fail it when skips are failures."""
    _require_none([name for name in programs if not shutil.which(name)], PACKAGES)


def require_library(name: str) -> None:
    """Likewise for a library: whether another process can load it, for it may have a licence that is not ours."""
    load = [sys.executable, "-I", "-S", "-c", f"import ctypes; ctypes.CDLL({name!r})"]
    there = subprocess.run(load, check=False, capture_output=True).returncode == 0
    _require_none([] if there else [name], LIBRARIES)


def require_page() -> None:
    """Likewise for the page of ``agentface/io/web``, which ``make page`` builds."""
    if not (PAGE / "agentface.js").is_file():
        (pytest.fail if strict() else pytest.skip)(f"not built: {PAGE}; make page builds it")


def _require_none(missing: list[str], packaged: dict[str, str]) -> None:
    if missing:
        packages = " ".join(dict.fromkeys(packaged.get(name, name) for name in missing))
        message = f"not on this machine: {', '.join(missing)}; apt-get install {packages} brings what is missing"
        (pytest.fail if strict() else pytest.skip)(message)


def _unskipped(report: pytest.TestReport | pytest.CollectReport) -> None:
    """Make a failure of a skip."""
    if report.skipped and strict() and not hasattr(report, "wasxfail"):
        reason = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr
        report.outcome = "failed"
        report.longrepr = f"skipped, which AGENTFACE_REQUIRE_TOOLS=1 forbids: {reason}"


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    _unskipped(report)
    return report


@pytest.hookimpl(wrapper=True)
def pytest_make_collect_report() -> Generator[None, pytest.CollectReport, pytest.CollectReport]:
    report = yield
    _unskipped(report)
    return report
