from __future__ import annotations

import tomllib

import pytest

from tests.matrix import ROOT, lowest, main, python_of

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def test_every_dependency_has_a_lowest_version():
    pins = dict(pin.split("==") for pin in lowest(PROJECT))
    assert pins["moderngl"] == "5.11.1"
    assert len(pins) == len(PROJECT["dependencies"]) + sum(map(len, PROJECT["optional-dependencies"].values()))


def test_a_dependency_without_one_is_refused():
    with pytest.raises(SystemExit, match=r"one lower bound, got numpy<3"):
        lowest({"dependencies": ["numpy<3"], "optional-dependencies": {}})


def test_a_python_that_is_missing_is_named_and_no_failure(monkeypatch, capsys):
    assert python_of("0.1") is None
    monkeypatch.setenv("PATH", "")
    assert main(["--only", "3.12"]) == 0
    assert "3.12     missing on this machine" in capsys.readouterr().out
