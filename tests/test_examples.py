from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parent.parent / "examples"
pytestmark = [pytest.mark.gl, pytest.mark.slow]


def run(name: str, *arguments: object) -> str:
    command = [sys.executable, str(EXAMPLES / name), *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=240).stdout


def size_of(path: Path) -> tuple[int, int]:
    from PIL import Image

    with Image.open(path) as image:
        return image.size


def frames(path: Path) -> list[float]:
    import av

    with av.open(str(path)) as container:
        return [float(frame.time) for frame in container.decode(video=0)]


def test_set_emotion(tmp_path):
    said = run("set_emotion.py", "fear", 0.9, tmp_path / "fear.png")
    assert size_of(tmp_path / "fear.png") == (640, 640)
    assert "risorius_l" in said


def test_moods(tmp_path):
    run("moods.py", tmp_path / "moods.mp4", "--seconds", 0.5, "--size", 96)
    assert frames(tmp_path / "moods.mp4") == pytest.approx([frame / 30 for frame in range(15)], abs=1e-4)


def test_make_demo_films_an_agent_in_another_process(tmp_path):
    said = run("make_demo.py", "--out", tmp_path, "--pace", 12)
    assert size_of(tmp_path / "expressions.png") == (1920, 1072)
    times = frames(tmp_path / "demo.mp4")
    assert times == sorted(set(times))
    assert times[-1] > 0.8
    assert "all is well again" in said
    assert "'malformed': 0, 'unknown': 0, 'rejected': 0" in said
    assert "agentface show" in said


def test_the_agent_says_how_to_start_a_face():
    with pytest.raises(subprocess.CalledProcessError) as error:
        run("osc_agent.py", "--osc", "127.0.0.1:9", "--wait", 0.2)
    assert "agentface serve" in error.value.stderr
