from __future__ import annotations

import tomllib
from itertools import chain

import pytest
from packaging.requirements import Requirement

from tests.matrix import ROOT, lowest, main, python_of

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]


def test_every_dependency_has_a_lowest_version():
    pins = dict(pin.split("==") for pin in lowest(PROJECT))
    assert pins["moderngl"] == "5.11.1"
    declared = [*PROJECT["dependencies"], *chain.from_iterable(PROJECT["optional-dependencies"].values())]
    assert pins.keys() == {Requirement(text).name for text in declared}


def test_a_dependency_without_one_is_refused():
    with pytest.raises(SystemExit, match=r"one lower bound, got numpy<3"):
        lowest({"dependencies": ["numpy<3"], "optional-dependencies": {}})


def test_a_python_that_is_missing_is_named_and_no_failure(monkeypatch, capsys, tmp_path):
    assert python_of("0.1") is None
    for name in ("PATH", "PYENV_ROOT", "UV_PYTHON_INSTALL_DIR"):
        monkeypatch.setenv(name, str(tmp_path))
    assert main(["--only", "3.12"]) == 0
    assert "3.12     missing on this machine" in capsys.readouterr().out


def test_a_python_of_pyenv_is_found_behind_a_shim_that_does_nothing(monkeypatch, tmp_path):
    shim, real = tmp_path / "python9.9", tmp_path / "versions" / "9.9.1" / "bin" / "python9.9"
    shim.write_text("#!/bin/sh\nexit 127\n")
    real.parent.mkdir(parents=True)
    real.write_text("#!/bin/sh\nexit 0\n")
    for path in (shim, real):
        path.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:/bin")
    monkeypatch.setenv("PYENV_ROOT", str(tmp_path))
    assert python_of("9.9") == str(real)
