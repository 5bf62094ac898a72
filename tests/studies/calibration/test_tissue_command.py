"""``agentface calibrate --deformer tissue``, with a fit that takes no time in place of the one that takes minutes."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.errors import DataError
from agentface.face import Face
from agentface.facs.action_units import load_action_units
from agentface.studies.calibration import fits
from agentface.studies.calibration.agreement import Agreement
from agentface.tissue.reading import anatomy_file, read_tissue
from agentface.tissue.tissue_file import TISSUE_MUSCLES
from tests import calibrated

FITTED = 4.25
"""The strength that the quick fit finds for risorius."""


def call(*arguments, code=0):
    return calibrated.call(*arguments, "--deformer", "tissue", code=code)


@pytest.fixture
def quick(monkeypatch):
    """Fits and measures nothing; the files from which fits started."""
    started = []

    class Fitter:
        def __init__(self, model, file):
            assert not model.landmarks["nasion"][0], "without asymmetry"
            started.append(file)

        def fit(self, progress):
            for name in TISSUE_MUSCLES:
                progress(f"{name}: 0.1")
            rows = started[-1].muscles
            stronger = rows["risorius"].model_copy(update={"strength": FITTED})
            return started[-1].model_copy(update={"muscles": rows | {"risorius": stronger}})

    def measured(model, file):
        cosine = 0.95 if file.muscles["risorius"].strength == FITTED else 0.7
        unit = load_action_units()
        return {number: Agreement(cosine, 1.0, 1.0, 5.0, "a", "b", fitted=unit[number].fitted) for number in unit}

    monkeypatch.setattr(fits, "TissueFitter", Fitter)
    monkeypatch.setattr(fits, "_measured", measured)
    return started


def test_the_fit_starts_at_the_anatomists_muscles_and_keeps_the_rest_of_the_face(face, quick):
    path = face / "tissue.yaml"
    text = path.read_text(encoding="utf-8")
    path.write_text(
        text.replace("  translate_mm: [0.0, 0.0, 0.0]", "  translate_mm: [0.0, 1.5, 0.0]"), encoding="utf-8"
    )
    own, anatomy = read_tissue(path), read_tissue(anatomy_file())
    result = call(face)
    (start,) = quick
    assert start.muscles == anatomy.muscles
    written = read_tissue(path)
    assert written.skull.translate_mm == [0.0, 1.5, 0.0]
    assert written.model_copy(update={"muscles": own.muscles}) == own
    assert written.muscles["risorius"].strength == FITTED
    assert written.muscles["mentalis"] == anatomy.muscles["mentalis"]
    assert "0.70 → 0.95" in result.stdout
    assert f"{path}: written" in result.stderr
    assert "expected" not in result.stderr
    assert "# From skin to bone." in path.read_text(encoding="utf-8"), "comments of the sections"


def test_a_face_without_tissue_or_muscles_gets_tissue(face, quick):
    (face / "tissue.yaml").unlink()
    (face / "muscles.yaml").unlink()
    call(face)
    assert quick == [read_tissue(anatomy_file())]
    assert read_tissue(face / "tissue.yaml").muscles["risorius"].strength == FITTED
    assert not (face / "muscles.yaml").exists()


def test_a_dry_run_writes_nothing(face, quick):
    path = face / "tissue.yaml"
    before = path.read_bytes()
    content = json.loads(call(face, "--dry-run", "--json", "-").stdout)
    assert path.read_bytes() == before
    assert len(quick) == 1
    assert set(content) == {"before", "after"}
    assert content["after"]["missed"] == []
    assert "mean cosine: expected at least 0.9, got 0.700" in content["before"]["missed"]
    assert not any(f"AU {number}:" in row for row in content["before"]["missed"] for number in (5, 18, 26))


def test_faults_of_the_faces_own_table_are_told_before_the_work(face, quick):
    path = face / "tissue.yaml"
    path.write_text(path.read_text(encoding="utf-8").replace("rho: 8.0", "rho: 80.0"), encoding="utf-8")
    said = call(face, code=1).stderr
    assert f"{path}:" in said
    assert "volume.rho: expected at most 12" in said
    assert not quick


def test_searches_are_for_vector_muscles(face, quick):
    for options in (["--starts", "2"], ["--seed", "1"]):
        assert "one start" in call(face, *options, code=2).stderr
    assert not quick


def test_the_table_of_the_tissue_has_its_own_place_in_a_document(tmp_path):
    path = tmp_path / "a.md"
    path.write_text("# Title\n", encoding="utf-8")
    assert "--deformer tissue" in call("onyx", "--table", "-o", path, code=1).stderr


def test_a_face_without_tissue_says_so_and_what_to_do(face):
    (face / "tissue.yaml").unlink()
    for deformer in ("tissue", "tissue-semi-implicit", "tissue-adaptive"):
        with pytest.raises(DataError) as caught:
            Face(face, deformer=deformer)
        (fault,) = caught.value.faults
        assert f"agentface calibrate {face} --deformer tissue" in fault.hint
    render = ["render", "--face", str(face), "--deformer", "tissue", "-o", str(face / "a.png")]
    result = CliRunner().invoke(cli, render, prog_name="agentface")
    assert result.exit_code == 1
    assert f"{face / 'tissue.yaml'}: expected this file, for the tissue deformer, got none" in result.stderr
    assert "Traceback" not in result.output
