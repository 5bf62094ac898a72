from __future__ import annotations

import json
import select
import socket
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

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


def test_the_agent_tells_what_the_face_says_in_the_end():
    """A face that is slow to start answers all that it was asked meanwhile, and the agent asks once a half second."""
    agent = ["osc_agent.py", "--wait", 20, "--pace", 50, "--osc"]
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as face, ThreadPoolExecutor() as pool:
        face.bind(("127.0.0.1", 0))
        face.settimeout(60)
        said = pool.submit(run, *agent, f"127.0.0.1:{face.getsockname()[1]}")
        waiting = [face.recvfrom(1024) for _ in range(3)]
        taken = asked = 0
        while not said.done():
            for datagram, sender in waiting:
                message = OscMessage(datagram)
                if message.address == "/agentface/status":
                    asked += 1
                    face.sendto(answer("/agentface/status", json.dumps({"messages": taken, "errors": {}})), sender)
                else:
                    taken += 1
                    face.sendto(answer("/agentface/error", message.address, "no", "really"), sender)
            waiting = [face.recvfrom(1024)] if select.select([face], [], [], 0.1)[0] else []
    assert asked == 4
    assert taken == 8
    assert "the face took 8 messages" in said.result()
    assert said.result().count("the face says: /agentface/emotions no really") == 7


def answer(address: str, *arguments: str) -> bytes:
    builder = OscMessageBuilder(address)
    for argument in arguments:
        builder.add_arg(argument)
    return builder.build().dgram


def test_the_agent_says_how_to_start_a_face():
    with pytest.raises(subprocess.CalledProcessError) as error:
        run("osc_agent.py", "--osc", "127.0.0.1:9", "--wait", 0.2)
    assert "agentface serve" in error.value.stderr
