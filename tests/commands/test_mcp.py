"""What the command refuses before it begins; tests/agents/mcp has what it does."""

from __future__ import annotations

import sys

import pytest
from click.testing import CliRunner

from agentface.cli import cli


def told(*arguments):
    done = CliRunner().invoke(cli, ["mcp", *arguments])
    assert done.exit_code != 0
    return done.output


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--token", "x" * 20], "--token goes with --http"),
        (["--allow-origin", "https://a.example"], "--allow-origin goes with --http"),
        (["--view", "none", "--quality", "fast"], "--quality goes with --view window"),
        (["--http", "8090"], "expected HOST:PORT"),
        (["--view", "both"], "window"),
        (["--face", "nobody"], "amber"),
    ],
)
def test_options_that_cannot_be_meant_are_one_line(arguments, expected):
    text = told(*arguments)
    assert expected in text
    assert "Traceback" not in text


def test_without_the_package_it_names_the_extra(monkeypatch):
    monkeypatch.setitem(sys.modules, "mcp.server.mcpserver", None)
    assert 'pip install "agentface[mcp]"' in told("--view", "none")


def test_its_help_has_what_a_program_is_told():
    done = CliRunner().invoke(cli, ["mcp", "--help"])
    assert '{"mcpServers": {"face": {"command": "agentface", "args": ["mcp"]}}}' in done.output
    assert "--http HOST:PORT" in done.output
