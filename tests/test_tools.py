from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.tools import LIBRARIES, PACKAGES

ROOT = Path(__file__).parent.parent

TESTS = """
import pytest
from tests.tools import require

def test_there(): require("sh")
def test_missing(): require("no-such-program")
def test_skipped(): pytest.skip("of its own will")
@pytest.mark.skipif(True, reason="by a mark")
def test_marked(): pass
@pytest.mark.xfail(reason="known", strict=True)
def test_expected(): raise ValueError
"""


def verdict(folder: Path, program: str, required: str) -> tuple[int, str]:
    (folder / "test_some.py").write_text(program)
    command = [sys.executable, "-m", "pytest", "-p", "tests.tools", "-p", "no:cacheprovider", "-rA", str(folder)]
    command += ["-c", "/dev/null", "--rootdir", str(folder)]
    environment = os.environ | {"AGENTFACE_REQUIRE_TOOLS": required}
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240, env=environment, cwd=ROOT)
    return done.returncode, done.stdout


@pytest.mark.slow
@pytest.mark.parametrize(
    ("required", "code", "counts"),
    [("0", 0, "1 passed, 3 skipped, 1 xfailed"), ("1", 1, "2 failed, 1 passed, 1 xfailed, 1 error")],
)
def test_a_skip_is_a_failure_when_tools_are_required(tmp_path, required, code, counts):
    returned, output = verdict(tmp_path, TESTS, required)
    assert returned == code
    assert counts in output
    assert "no-such-program" in output


@pytest.mark.slow
@pytest.mark.parametrize(("required", "code"), [("0", 5), ("1", 2)])
def test_a_file_that_is_skipped_whole_is_a_failure_too(tmp_path, required, code):
    returned, output = verdict(tmp_path, "import pytest; pytest.importorskip('no_such_module')", required)
    assert returned == code
    assert "no_such_module" in output


def test_the_makefile_brings_every_tool():
    tools = re.findall(r"^(?:SOAK_)?TOOLS := (.+)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert dict(pair.split(":") for pair in " ".join(tools).split()) == PACKAGES
    libraries = re.search(r"^LIBRARIES := (.+)$", (ROOT / "Makefile").read_text(), re.MULTILINE)
    assert dict(pair.split(":") for pair in libraries[1].split()) == LIBRARIES
