from __future__ import annotations

import json
import select
import socket
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from pythonosc.osc_message import OscMessage
from pythonosc.osc_message_builder import OscMessageBuilder

from tests.display import on_a_virtual_display
from tests.tools import require

EXAMPLES = Path(__file__).parent.parent / "examples"
pytestmark = [pytest.mark.gl, pytest.mark.slow, pytest.mark.untraced]


def run(name: str, *arguments: object, before: Sequence[str] = ()) -> str:
    command = [*before, sys.executable, str(EXAMPLES / name), *map(str, arguments)]
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


def test_a_speaker_is_filmed_with_all_of_its_sound(tmp_path):
    pytest.importorskip("pocketsphinx")
    said = run("speaker.py", EXAMPLES / "hello.wav", tmp_path / "speaker.mp4", "--size", 96)
    times = frames(tmp_path / "speaker.mp4")
    assert times == pytest.approx([frame / 25 for frame in range(len(times))], abs=1e-4)
    assert f"{len(times)} frames, 4.57 s of sound" in said


def test_a_program_uses_the_tools_of_a_face_in_a_window(tmp_path):
    pytest.importorskip("mcp")
    pytest.importorskip("glfw")
    require("xvfb-run")
    said = run("mcp_agent.py", "--picture", tmp_path / "seen.png", before=on_a_virtual_display())
    assert size_of(tmp_path / "seen.png") == (512, 512)
    assert "'happiness': 0.8" in said
    assert "expected the name of one gesture, got 'wave'" in said


def test_make_demo_films_an_agent_in_another_process(tmp_path):
    said = run("make_demo.py", "--out", tmp_path, "--pace", 12, "--mute")
    assert size_of(tmp_path / "expressions.png") == (1920, 1072)
    times = frames(tmp_path / "demo.mp4")
    assert times == sorted(set(times))
    assert times[-1] > 0.8
    assert "all is well again" in said
    assert "'malformed': 0, 'unknown': 0, 'rejected': 0" in said
    assert "agentface show" in said


def test_the_agent_tells_what_the_face_says_in_the_end():
    """A face that is slow to start answers all that it was asked meanwhile, and the agent asks once a half second."""
    taken, said = told_to_a_face("--mute", refused="/agentface/emotions", slow=3)
    asked = [address for address, _ in taken].count("/agentface/status")
    assert asked >= 4, "and oftener where this face is slow to answer later, too"
    assert len(taken) - asked == 8
    assert "the face took 8 messages" in said
    assert said.count("the face says: /agentface/emotions no really") == 7


def test_the_agent_says_what_it_feels_one_sentence_after_the_other():
    taken, said = told_to_a_face()
    told = [(address, arguments) for address, arguments in taken if address != "/agentface/status"]
    assert [address for address, _ in told] == ["/agentface/emotions", "/agentface/say"] * 7 + ["/agentface/neutral"]
    assert told[1][1] == ["Oh! It is you!"]
    assert "the face took 15 messages" in said


def test_without_a_voice_the_agent_lets_the_mouth_say_a_recording():
    taken, _ = told_to_a_face("--phones", EXAMPLES / "hello.json")
    known = dict(taken)
    assert "/agentface/say" not in known
    phones = json.loads((EXAMPLES / "hello.json").read_text())["phones"]
    assert known["/agentface/visemes"][::3] == [symbol for symbol, _, _ in phones]
    assert known["/agentface/visemes"][2::3] == pytest.approx([end for _, _, end in phones])


def told_to_a_face(*arguments: object, refused: str = "", slow: int = 1) -> tuple[list[tuple[str, list]], str]:
    """What the agent tells a face, and what it prints; the face speaks for two questions after it is told to."""
    agent = ["osc_agent.py", "--wait", 200, "--pace", 50, *arguments, "--osc"]
    taken: list[tuple[str, list]] = []
    speaks = 0
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as face, ThreadPoolExecutor() as pool:
        face.bind(("127.0.0.1", 0))
        face.settimeout(200)
        said = pool.submit(run, *agent, f"127.0.0.1:{face.getsockname()[1]}")
        waiting = [face.recvfrom(8192) for _ in range(slow)]
        while not said.done():
            for datagram, sender in waiting:
                message = OscMessage(datagram)
                taken.append((message.address, list(message.params)))
                if message.address == "/agentface/status":
                    count = sum(address != "/agentface/status" for address, _ in taken)
                    speech, speaks = {"phone": "aa"} if speaks else None, max(0, speaks - 1)
                    status = {"messages": count, "errors": {}, "speech": speech}
                    face.sendto(answer("/agentface/status", json.dumps(status)), sender)
                elif message.address == "/agentface/say":
                    speaks = 2
                elif message.address == refused:
                    face.sendto(answer("/agentface/error", message.address, "no", "really"), sender)
            waiting = [face.recvfrom(8192)] if select.select([face], [], [], 0.1)[0] else []
    return taken, said.result()


def answer(address: str, *arguments: str) -> bytes:
    builder = OscMessageBuilder(address)
    for argument in arguments:
        builder.add_arg(argument)
    return builder.build().dgram


def test_the_agent_says_how_to_start_a_face():
    with pytest.raises(subprocess.CalledProcessError) as error:
        run("osc_agent.py", "--osc", "127.0.0.1:9", "--wait", 0.2)
    assert "agentface serve" in error.value.stderr
