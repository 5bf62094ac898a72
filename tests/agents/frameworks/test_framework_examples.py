"""The examples that need a framework: make frameworks."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest
from PIL import Image

pytestmark = pytest.mark.frameworks
EXAMPLES = Path(__file__).parents[3] / "examples"


def test_pipecat_s_example_writes_pictures_of_a_face_that_speaks(tmp_path):
    command = [sys.executable, str(EXAMPLES / "pipecat_face.py"), "Hello, you.", str(tmp_path)]
    done = subprocess.run(command, check=True, capture_output=True, text=True, timeout=900)
    pictures = sorted(tmp_path.glob("*.png"))
    assert pictures
    with Image.open(pictures[0]) as picture:
        assert picture.size == (384, 384)
    assert " s were heard" in done.stdout


def test_livekit_s_example_names_what_there_is():
    spec = importlib.util.spec_from_file_location("livekit_face", EXAMPLES / "livekit_face.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert callable(module.entrypoint)
