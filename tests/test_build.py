"""``agentface build``: a face of one's own, from a recipe to a picture."""

from __future__ import annotations

import shutil

import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.commands.build import _borrowed
from agentface.head.build import head_topology, source
from agentface.head.model import load_model
from agentface.resources import face_folder
from agentface.tissue.reading import anatomy_file
from tests.base_mesh import topology


def call(*arguments, code=0):
    result = CliRunner().invoke(cli, [str(argument) for argument in arguments], prog_name="agentface")
    assert result.exit_code == code, result.output
    return result


@pytest.fixture
def recipe(tmp_path, monkeypatch):
    """A recipe that is not shipped, and a folder for the user's data."""
    monkeypatch.setenv("AGENTFACE_DATA", str(tmp_path / "data"))
    text = (face_folder("onyx") / "recipe.yaml").read_text()
    path = tmp_path / "sam.yaml"
    path.write_text(text.replace("head/head-square: 0.1", "head/head-square: 0.4"))
    return path


@pytest.fixture
def one_mesh(monkeypatch):
    """Whoever builds shares the mesh that is cut."""
    monkeypatch.setattr(source, "BaseMesh", lambda data: topology().mesh)
    monkeypatch.setattr(head_topology, "HeadTopology", lambda mesh: topology())


@pytest.mark.slow
@pytest.mark.usefixtures("one_mesh")
def test_a_recipe_becomes_a_face_that_its_name_finds(recipe, tmp_path):
    said = call("build", recipe, "--face", "onyx")
    folder = tmp_path / "data" / "regions" / "sam"
    assert f"{folder}: written; agentface show --face sam" in said.stdout
    assert "mixing the person" in said.stderr
    model, onyx = load_model("sam"), load_model("onyx")
    assert (model.name, model.folder) == ("sam", folder)
    assert 0.0005 < abs(model.vertices - onyx.vertices).max() < 0.02
    assert (folder / "muscles.yaml").read_bytes() == (face_folder("onyx") / "muscles.yaml").read_bytes()
    assert (folder / "tissue.yaml").read_bytes() == (face_folder("onyx") / "tissue.yaml").read_bytes()
    assert (folder / "recipe.yaml").read_bytes() == recipe.read_bytes()
    assert "Where the face sam comes from" in (folder / "PROVENANCE.md").read_text()
    assert "sam: good" in call("check", "--face", "sam").stdout

    (folder / "muscles.yaml").write_text((face_folder("amber") / "muscles.yaml").read_text())
    glb = (folder / "head.glb").read_bytes()
    call("build", folder / "recipe.yaml", "-o", folder)
    assert (folder / "head.glb").read_bytes() == glb
    assert (folder / "muscles.yaml").read_bytes() == (face_folder("amber") / "muscles.yaml").read_bytes(), "kept"


def test_a_new_face_gets_the_lenders_tissue_or_the_anatomists(tmp_path):
    own, lender = tmp_path / "own", tmp_path / "lender"
    for folder in (own, lender):
        folder.mkdir()
    for name in ("tissue.yaml", "muscles.yaml"):
        (lender / name).write_text("")
    assert _borrowed("tissue.yaml", own, lender) == lender / "tissue.yaml"
    (own / "tissue.yaml").write_text("")
    assert _borrowed("tissue.yaml", own, lender) == own / "tissue.yaml"
    for folder in (own, lender):
        (folder / "tissue.yaml").unlink()
    assert _borrowed("tissue.yaml", own, lender) == anatomy_file()
    assert _borrowed("muscles.yaml", own, lender) == lender / "muscles.yaml"


def test_a_name_that_is_taken_is_refused(tmp_path):
    shutil.copy(face_folder("amber") / "recipe.yaml", tmp_path / "onyx.yaml")
    assert (
        "another than those of agentface's own faces, got 'onyx'"
        in call("build", tmp_path / "onyx.yaml", code=1).stderr
    )
    assert "got 'amber'" in call("build", face_folder("amber") / "recipe.yaml", code=1).stderr


@pytest.mark.slow
@pytest.mark.usefixtures("one_mesh")
def test_a_wrong_recipe_changes_nothing(recipe, tmp_path):
    recipe.write_text(recipe.read_text().replace("female:", "femal:"))
    said = call("build", recipe, code=1).stderr
    assert f"{recipe}:3: femal: expected no such key" in said
    assert not (tmp_path / "data" / "regions" / "sam").exists()
    assert f"{tmp_path / 'none.yaml'}: expected a readable file" in call("build", tmp_path / "none.yaml", code=1).stderr


def test_a_place_that_cannot_be_written_is_told_before_the_work(recipe, tmp_path):
    (tmp_path / "file").write_text("")
    said = call("build", recipe, "-o", tmp_path / "file" / "face", code=1).stderr
    assert "expected to write it" in said
    assert "Traceback" not in said
