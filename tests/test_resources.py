from __future__ import annotations

import shutil

import pytest

from agentface.errors import UnknownNameError
from agentface.head.model import load_model
from agentface.resources import data_folder, face_folder, face_names, user_face_names, user_faces_folder


@pytest.fixture
def own(tmp_path, monkeypatch):
    """The user's folder of faces, with one that is called mine."""
    monkeypatch.setenv("AGENTFACE_DATA", str(tmp_path))
    shutil.copytree(face_folder("amber"), tmp_path / "regions" / "mine")
    return tmp_path / "regions"


@pytest.mark.parametrize(
    ("variables", "folder"),
    [
        ({"AGENTFACE_DATA": "/a", "XDG_DATA_HOME": "/x", "HOME": "/h"}, "/a/regions"),
        ({"XDG_DATA_HOME": "/x", "HOME": "/h"}, "/x/agentface/regions"),
        ({"HOME": "/h"}, "/h/.local/share/agentface/regions"),
        ({"AGENTFACE_DATA": "~/faces", "HOME": "/h"}, "/h/faces/regions"),
        ({"AGENTFACE_DATA": "", "XDG_DATA_HOME": "", "HOME": "/h"}, "/h/.local/share/agentface/regions"),
    ],
)
def test_own_faces_have_a_place(monkeypatch, variables, folder):
    for name in ("AGENTFACE_DATA", "XDG_DATA_HOME", "HOME"):
        monkeypatch.delenv(name, raising=False)
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert str(user_faces_folder()) == folder
    assert user_face_names() == ()


def test_own_faces_are_found_by_name(own):
    assert user_face_names() == ("mine",)
    assert face_folder("mine") == own / "mine"
    assert load_model("mine").name == "mine"
    assert "mine" not in face_names()
    with pytest.raises(UnknownNameError, match="did you mean mine"):
        face_folder("mene")


def test_no_face_takes_the_name_of_agentface_s_own(own):
    shutil.copytree(own / "mine", own / "onyx")
    assert user_face_names() == ("mine",)
    assert face_folder("onyx") == data_folder("regions") / "onyx"
    assert face_folder(own / "onyx") == own / "onyx"


def test_nobody_has_a_home(monkeypatch):
    def homeless(self):
        raise RuntimeError("Could not determine home directory.")

    monkeypatch.delenv("AGENTFACE_DATA", raising=False)
    monkeypatch.delenv("XDG_DATA_HOME", raising=False)
    monkeypatch.setattr("pathlib.Path.expanduser", homeless)
    assert face_folder("amber").is_dir()
    with pytest.raises(UnknownNameError, match="known: amber, onyx"):
        face_folder("~nobody/face")
