from __future__ import annotations

import json

import pytest

from agentface.head.model import load_model
from agentface.head.muscles import read_muscles
from agentface.resources import face_names
from agentface.studies.calibration import calibrate as fitting
from agentface.studies.calibration.calibrate import anatomy_file, table
from agentface.studies.calibration.limits import END, begin_of
from tests.calibrated import call
from tests.heads import head_model


@pytest.fixture
def quick(monkeypatch):
    """In place of the fit, which takes minutes: the anatomist's muscles, and what was asked for."""
    asked = []

    def fit(face, starts, seed, progress):
        asked.append((str(face), starts, seed))
        for _ in range(200):
            progress("AU 1: start 1, cost 0.1")
        return read_muscles(anatomy_file())

    monkeypatch.setattr(fitting, "calibrate", fit)
    return asked


def test_the_table_of_all_faces_or_of_one():
    assert call("--table").stdout == table([head_model(name) for name in face_names()])
    assert call("onyx", "--table").stdout == table([head_model("onyx")])
    assert call("--table", "--face", "onyx", "-o", "-").stdout == table([head_model("onyx")])


def test_the_table_as_json():
    content = json.loads(call("onyx", "--table", "--json", "-").stdout)
    assert list(content) == ["onyx"]
    assert content["onyx"]["missed"] == []
    assert content["onyx"]["mean_cosine"] >= 0.85
    row = content["onyx"]["action_units"]["12"]
    assert set(row) == {"cosine", "covered", "peak_ratio", "peak_mm", "region", "artists_region", "fitted"}


def test_the_table_goes_into_a_document(tmp_path):
    path = tmp_path / "a.md"
    path.write_text(f"# Title\n{begin_of()}{END}End\n", encoding="utf-8")
    call("onyx", "--table", "-o", path)
    assert path.read_text(encoding="utf-8") == f"# Title\n{begin_of()}{table([head_model('onyx')])}{END}End\n"


def test_a_document_without_a_place_is_left_alone(tmp_path):
    path = tmp_path / "a.md"
    path.write_text("# Title\n", encoding="utf-8")
    assert str(path) in call("onyx", "--table", "-o", path, code=1).stderr
    assert path.read_text(encoding="utf-8") == "# Title\n"
    assert "b.md" in call("onyx", "--table", "-o", tmp_path / "b.md", code=1).stderr


@pytest.mark.slow
def test_a_fit_is_written_to_the_face_and_printed(face, quick):
    result = call(face, "--starts", 3, "--seed", 5)
    assert quick == [(str(face), 3, 5)]
    assert read_muscles(face / "muscles.yaml") == read_muscles(anatomy_file())
    assert "brow lowerer" in result.stdout
    assert "→" in result.stdout
    assert "expected" in result.stderr  # the anatomist's muscles alone miss the limits, and it is said


@pytest.mark.slow
def test_a_dry_run_writes_nothing(face, quick):
    before = (face / "muscles.yaml").read_bytes()
    content = json.loads(call(face, "--dry-run", "--json", "-").stdout)
    assert set(content) == {"before", "after"}
    assert content["before"]["missed"] == []
    assert content["after"]["missed"]
    assert len(quick) == 1
    assert (face / "muscles.yaml").read_bytes() == before


@pytest.mark.slow
def test_a_face_without_muscles_yet_gets_them(face, quick):
    (face / "muscles.yaml").unlink()
    call(face)
    assert load_model(face).muscles_file == read_muscles(anatomy_file())


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["amber", "--face", "onyx"],
        ["--table", "--dry-run"],
        ["amber", "-o", "a.md"],
        ["amber", "--starts", "0"],
        ["amber", "--seed", "-1"],
    ],
)
def test_usage_errors(options, quick):
    assert "Usage" in call(*options, code=2).stderr
    assert not quick


def test_unknown_faces_and_deformers(quick):
    assert "known: amber, onyx" in call("nobody", code=1).stderr
    assert "known: geometric" in call("amber", "--deformer", "jelly", code=1).stderr
    assert not quick
