"""What commands share: the wait for a face is told, to a terminal alone."""

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


@pytest.fixture
def screen(monkeypatch):
    """What a terminal is told while a face is made, which takes no time here."""
    said = StringIO()
    face = SimpleNamespace(warm_up=lambda *, solvers: said.write("solvers, too" if solvers else "warmed up"))
    monkeypatch.setattr("agentface.face.Face", lambda *_, **__: face)
    monkeypatch.setattr(options, "console", lambda: Console(file=said, force_terminal=True, width=120))
    return said


@pytest.mark.parametrize(
    ("kept", "compiled", "told", "untold"),
    [
        (False, True, "compiling for this machine", "preparing"),
        (True, True, "preparing onyx", "compiling"),
        (False, False, "preparing onyx", "compiling"),
    ],
)
def test_a_terminal_is_told_why_it_waits(monkeypatch, screen, kept, compiled, told, untold):
    monkeypatch.setattr(kernel, "any_kept", lambda: kept)
    options.make_face("onyx", "tissue", compiled=compiled)
    assert told in screen.getvalue()
    assert untold not in screen.getvalue()


def test_a_deformer_that_compiles_a_part_leaves_the_wait_for_the_rest_told(monkeypatch, screen):
    kept = iter([False, True])
    monkeypatch.setattr(kernel, "any_kept", lambda: next(kept))
    options.make_face("onyx", "tissue", running=True)
    assert "warmed up" in screen.getvalue()
    assert "compiling for this machine" in screen.getvalue()
    assert "preparing" not in screen.getvalue()


def test_what_is_driven_compiles_what_solves_for_it_the_first_time(monkeypatch, screen):
    kept = {"deform": True, "mpeg4": False}
    monkeypatch.setattr(kernel, "any_kept", lambda room="deform": kept[room])
    options.make_face("onyx", "geometric", running=True, driven=True)
    assert "solvers, too" in screen.getvalue()
    assert "compiling for this machine" in screen.getvalue()
    kept["mpeg4"] = True
    options.make_face("onyx", "geometric", running=True, driven=True)
    assert "warmed up" in screen.getvalue()


def test_what_is_no_terminal_is_told_nothing(monkeypatch, screen):
    monkeypatch.setattr(options, "console", lambda: Console(file=screen, force_terminal=False))
    options.make_face("onyx", "tissue", running=True)
    assert screen.getvalue() == "warmed up"


def test_kernels_are_kept_once_one_is_compiled(tmp_path, monkeypatch):
    for folder, kept in ((None, False), (tmp_path, False)):
        monkeypatch.setattr(kernel, "_folder", lambda room, folder=folder: folder)
        assert kernel.any_kept() is kept
    twice = kernel.kernel()(lambda number: number + number)
    assert not kernel.any_kept()
    assert twice(2) == 4
    assert kernel.any_kept()


def test_the_help_of_a_command_names_every_deformer():
    told = " ".join(CliRunner().invoke(cli, ["render", "--help"]).output.split())
    assert all(name in told for name in deformer_names())
