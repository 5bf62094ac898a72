"""Standard streams that are closed, full, or not there: one line, no traceback."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

pytestmark = [pytest.mark.slow, pytest.mark.untraced]
FULL, CLOSED, BROKEN = (
    ("> /dev/full", "No space left on device"),
    (">&-", "Bad file descriptor"),
    ("| true", "Broken pipe"),
)


def shell(line: str, **environment: str) -> subprocess.CompletedProcess[str]:
    command = f'face() {{ "{sys.executable}" -m agentface "$@"; echo "code $?" >&2; }}; {line}'
    return subprocess.run(
        ["bash", "-c", command], check=False, capture_output=True, text=True, timeout=240, env=os.environ | environment
    )


@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize(
    ("command", "output"),
    [
        ("explain happiness=0.5", FULL),
        ("explain happiness=0.5 --json -", BROKEN),
        ("check --face amber", FULL),
        ("--help", CLOSED),
        ("render --help", FULL),
        ("--version", BROKEN),
    ],
)
def test_an_output_that_cannot_be_written_is_one_line(command, output, unbuffered):
    to, reason = output
    # a pipe breaks when its reader has ended
    line = f"{{ sleep 0.3; face {command}; }} {to}" if to.startswith("|") else f"face {command} {to}"
    done = shell(line, PYTHONUNBUFFERED=unbuffered)
    told, code = done.stderr.splitlines()
    assert told.startswith(f"agentface: standard output: expected to write it, got: {reason};")
    assert code == "code 1"
    assert done.stdout == ""


def test_what_was_read_is_whole_and_the_rest_is_told():
    done = shell("face check | { read line; echo first: $line; }")
    assert done.stdout.startswith("first: ")
    assert done.stdout.endswith(": good\n")
    assert done.stderr.splitlines()[-1] == "code 1"
    assert "Traceback" not in done.stderr


def test_a_server_runs_on_without_an_output():
    for to in ("> /dev/full", ">&-"):
        done = shell(f"face serve --osc 127.0.0.1:0 --duration 0.2 {to}")
        told, code = done.stderr.splitlines()
        assert told.startswith("agentface: standard output: ")
        assert code == "code 0"


def test_errors_that_nobody_hears():
    done = shell(f'"{sys.executable}" -m agentface render -o no/a.png 2> /dev/full; echo $?')
    assert (done.stdout, done.stderr) == ("1\n", "")
