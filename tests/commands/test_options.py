"""What commands share: the wait for the compiler is told, once a machine and to a terminal alone."""

from __future__ import annotations

from io import StringIO
from types import SimpleNamespace

import pytest
from click.testing import CliRunner
from rich.console import Console

from agentface import kernel
from agentface.cli import cli
from agentface.commands import options
from agentface.deform.protocol import deformer_names


@pytest.mark.parametrize(
    ("terminal", "kept", "told"), [(True, False, True), (True, True, False), (False, False, False)]
)
def test_a_terminal_is_told_that_kernels_are_compiled(monkeypatch, terminal, kept, told):
    screen, warmed = StringIO(), []
    monkeypatch.setattr(options, "console", lambda: Console(file=screen, force_terminal=bool(terminal), width=120))
    monkeypatch.setattr(kernel, "any_kept", lambda: bool(kept))
    options.warm_up(SimpleNamespace(warm_up=lambda: warmed.append(1)))
    assert warmed == [1]
    assert ("compiling for this machine" in screen.getvalue()) is told


def test_kernels_are_kept_once_one_is_compiled(tmp_path, monkeypatch):
    for folder, kept in ((None, False), (tmp_path, False)):
        monkeypatch.setattr(kernel, "_folder", lambda folder=folder: folder)
        assert kernel.any_kept() is kept
    twice = kernel.kernel()(lambda number: number + number)
    assert not kernel.any_kept()
    assert twice(2) == 4
    assert kernel.any_kept()


def test_the_help_of_a_command_names_every_deformer():
    told = " ".join(CliRunner().invoke(cli, ["render", "--help"]).output.split())
    assert all(name in told for name in deformer_names())
