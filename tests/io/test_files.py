from __future__ import annotations

import stat

import numpy as np
import pytest

from agentface.errors import OutputError
from agentface.io.files import write_file
from agentface.io.picture import write_picture


def test_a_file_is_replaced_as_a_whole(tmp_path):
    path = tmp_path / "a.json"
    write_file(path, b"old")
    write_file(path, b"new")
    assert path.read_bytes() == b"new"
    assert [each.name for each in tmp_path.iterdir()] == ["a.json"]
    assert stat.S_IMODE(path.stat().st_mode) & 0o600 == 0o600


def test_a_failure_leaves_what_was_there(tmp_path, monkeypatch):
    path = tmp_path / "a.json"
    write_file(path, b"old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("pathlib.Path.replace", full)
    with pytest.raises(OutputError, match="No space left"):
        write_file(path, b"new")
    assert path.read_bytes() == b"old"
    assert [each.name for each in tmp_path.iterdir()] == ["a.json"]


def test_folders_are_named(tmp_path):
    with pytest.raises(OutputError, match="got a folder"):
        write_file(tmp_path, b"")
    with pytest.raises(OutputError, match="make it first"):
        write_file(tmp_path / "no" / "a", b"")


def test_pictures_come_back(tmp_path):
    from PIL import Image

    image = np.arange(4 * 6 * 3, dtype=np.uint8).reshape(4, 6, 3)
    write_picture(tmp_path / "a.png", image)
    with Image.open(tmp_path / "a.png") as read:
        np.testing.assert_array_equal(np.asarray(read), image)
    with pytest.raises(OutputError, match=r"\.png"):
        write_picture(tmp_path / "a.gif", image)
