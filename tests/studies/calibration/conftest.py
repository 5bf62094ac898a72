"""A face to calibrate."""

from __future__ import annotations

import shutil

import pytest

from agentface.resources import face_folder


@pytest.fixture
def face(tmp_path):
    return shutil.copytree(face_folder("onyx"), tmp_path / "face")
