"""``agentface serve``: what it answers, films and shows, and how it ends."""

from __future__ import annotations

import json
import os
import re
import signal
import socket
import subprocess
import sys
import threading
from types import SimpleNamespace

import click
import numpy as np
import pytest
from click.testing import CliRunner

from agentface import Face
from agentface.cli import cli
from agentface.commands.vmc import VmcOptions
from tests.clocks import ServedClock


def call(*arguments):
    return CliRunner().invoke(cli, ["serve", *map(str, arguments)], prog_name="agentface")


def fail(*arguments, code=1):
    """Run a command that must fail cleanly; its message."""
    result = call(*arguments)
    assert result.exit_code == code, result.output
    assert isinstance(result.exception, SystemExit)
    assert "Traceback" not in result.stderr
    return result.stderr


def test_a_taken_port_is_one_clear_message():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        assert f"port {port}" in fail("--osc", f"127.0.0.1:{port}", "--duration", "1")


@pytest.mark.parametrize(
    "options", [["--osc", "7400"], ["--osc", "host:99999"], ["--duration", "0"], ["--view", "tv"], ["--look", "ginger"]]
)
def test_usage(options):
    fail(*options, code=2)


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--vmc", "39539"], "expected HOST:PORT"),
        (["--vmc-in", "127.0.0.1:99999"], "expected HOST:PORT"),
        (["--vmc", "127.0.0.1:39539", "--vmc-names", "vrm"], "'vrm0', 'vrm1'"),
        (["--vmc-names", "vrm1"], "--vmc-names goes with --vmc"),
        (["--vmc-eyes", "shapes"], "--vmc-eyes goes with --vmc"),
        (["--vmc-axes", "gltf"], "--vmc-axes goes with --vmc or --vmc-in"),
        (["--vmc-id", "amber"], "--vmc-id goes with --vmc or --vmc-in"),
        (["--vmc", "127.0.0.1:39539", "--vmc-in", "127.0.0.1:39539"], "the face would drive itself"),
    ],
)
def test_usage_of_vmc(options, told):
    assert told in fail("--osc", "127.0.0.1:0", "--duration", "0.1", *options, code=2)


def test_vmc_is_for_the_first_face_or_the_one_that_is_named():
    faces = {"left": object(), "right": object()}

    def options(name):
        return VmcOptions(("127.0.0.1", 1), None, "vrm0", "unity", "bones", name)

    assert list(options(None).first(faces)) == ["left", "right"]
    assert list(options("right").first(faces)) == ["right", "left"]
    with pytest.raises(click.UsageError, match="expected one of left, right, got 'up'"):
        options("up").first(faces)


@pytest.mark.slow
def test_vmc_of_one_of_several_faces():
    """A tracker's head turns the face that is named, and the avatar gets that one's."""
    from agentface.io.osc.codec import decode

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as avatar:
        avatar.bind(("127.0.0.1", 0))
        avatar.settimeout(10)
        words = ("--face", "amber", "--id", "left", "--face", "onyx", "--id", "right", "--liveliness", "0")
        linked = ("--vmc", f"127.0.0.1:{avatar.getsockname()[1]}", "--vmc-in", "127.0.0.1:0")
        linked += ("--vmc-id", "right", "--vmc-names", "arkit")
        result = call("--osc", "127.0.0.1:0", "--duration", "0.2", *words, *linked)
        assert result.exit_code == 0, result.output
        sent = decode(avatar.recv(65536))
        assert f"right is sent by VMC to 127.0.0.1:{avatar.getsockname()[1]}" in result.output
    assert "right is driven by VMC on 127.0.0.1:" in result.output
    assert [message.address for message in sent].count("/VMC/Ext/Blend/Val") == 52


@pytest.mark.slow
def test_a_taken_port_of_vmc_is_one_clear_message():
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as taken:
        taken.bind(("127.0.0.1", 0))
        port = taken.getsockname()[1]
        told = fail("--osc", "127.0.0.1:0", "--vmc-in", f"127.0.0.1:{port}", "--duration", "1")
    assert f"port {port}" in told
    assert "--vmc-in HOST:PORT" in told


@pytest.mark.slow
def test_a_tracker_s_smile_leaves_for_an_avatar():
    """A whole server: what comes by VMC moves the face, and leaves by VMC."""
    from agentface.io.osc.codec import decode
    from agentface.io.vmc.bundle import FrameBundle

    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as avatar:
        avatar.bind(("127.0.0.1", 0))
        avatar.settimeout(200)
        linked = ("--vmc", f"127.0.0.1:{avatar.getsockname()[1]}", "--vmc-in", "127.0.0.1:0")
        command = [sys.executable, "-m", "agentface", "serve", "--osc", "127.0.0.1:0", "--liveliness", "0", *linked]
        environment = os.environ | {"PYTHONUNBUFFERED": "1"}
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment) as server:
            watchdog = threading.Timer(280, server.kill)
            watchdog.start()
            try:
                server.stdout.readline()
                port = int(re.search(r"driven by VMC on 127.0.0.1:(\d+)", server.stdout.readline())[1])
                smile = FrameBundle(["Joy"]).packet(0.0, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0] * 4, np.ones(1))
                shown = 0.0
                while shown < 0.5:
                    avatar.sendto(smile, ("127.0.0.1", port))
                    values = [m.arguments for m in decode(avatar.recv(65536)) if m.address == "/VMC/Ext/Blend/Val"]
                    shown = dict(values)["Joy"]
            finally:
                watchdog.cancel()
                server.terminate()
    assert server.returncode == 0


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("kind", [signal.SIGINT, signal.SIGTERM])
def test_it_answers_and_ends_when_told(kind):
    from pythonosc.osc_message import OscMessage
    from pythonosc.osc_message_builder import OscMessageBuilder

    server = subprocess.Popen(
        [sys.executable, "-m", "agentface", "serve", "--osc", "127.0.0.1:0"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=os.environ | {"PYTHONUNBUFFERED": "1"},
    )  # fmt: skip
    try:
        watchdog = threading.Timer(280, server.kill)
        watchdog.start()
        place = re.search(r"amber listens to OSC on 127.0.0.1:(\d+)", server.stdout.readline())
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
            client.connect(("127.0.0.1", int(place[1])))
            client.settimeout(200)
            client.send(OscMessageBuilder("/agentface/status").build().dgram)
            assert json.loads(OscMessage(client.recv(65536)).params[0])["face"] == "amber"
        server.send_signal(kind)
        _, errors = server.communicate(timeout=200)
        assert server.returncode == 0
        assert errors == ""
    finally:
        watchdog.cancel()
        server.kill()
        server.wait()


@pytest.fixture
def counted():
    """The loop's time is counted in place of the machine's: work takes none of it."""
    clock = ServedClock()
    with clock.at_work():
        yield clock


@pytest.mark.gl
def test_it_records_a_film(tmp_path, counted):
    path = tmp_path / "film.mp4"
    result = call("--osc", "127.0.0.1:0", "--record", path, "--duration", "0.55", "--fps", "10", "--size", "96x64")
    assert result.exit_code == 0, result.output
    seen = times(path)
    assert seen == sorted(set(seen))
    assert {round(10 * time_s, 3) for time_s in seen} <= set(range(6))
    assert seen[-1] == pytest.approx(0.5, abs=1e-4), "the last frame is filmed, however slow the drawing"


def times(path):
    """Those of a film's frames."""
    import av

    with av.open(str(path)) as film:
        return [float(frame.time) for frame in film.decode(video=0)]


@pytest.mark.slow
@pytest.mark.gl
def test_it_films_and_shows_a_look(tmp_path, monkeypatch, counted):
    from PIL import Image

    words = ("--osc", "127.0.0.1:0", "--liveliness", "0", "--look")
    filmed = ("--record", tmp_path / "face-%05d.png", "--duration", "0.05", "--fps", "10", "--size", "96x64")
    assert "'nobody'" in fail(*words, "nobody", *filmed)
    assert not list(tmp_path.iterdir())
    result = call(*words, "ginger", *filmed)
    assert result.exit_code == 0, result.output
    with Image.open(tmp_path / "face-00000.png") as film:
        picture = np.asarray(film)
    np.testing.assert_array_equal(picture, Face(look="ginger").render((96, 64), alpha=True))
    assert (picture != Face().render((96, 64), alpha=True)).any()

    shown = []
    window = SimpleNamespace(run=lambda sources, sinks, stopped: shown.append((len(sources), stopped())))

    def make_window(face, **options):
        shown.append(tuple(options.values()))
        return window

    monkeypatch.setattr("agentface.commands.show.make_window", make_window)
    assert call(*words, "ginger", "--view", "window").exit_code == 0
    assert call(*words, "ginger", "--view", "window", "--quality", "portrait", "--camera", "profile").exit_code == 0
    assert shown == [("ginger", None, "front"), (1, False), ("ginger", "portrait", "profile"), (1, False)]


@pytest.mark.gl
def test_frames_that_are_left_out_are_counted_and_told(tmp_path, monkeypatch, counted):
    from agentface.live.films import FilmSink

    path, show, began, over = tmp_path / "film.mp4", FilmSink.show, threading.Event(), threading.Event()

    def slowly(sink, frame):
        began.set()
        over.wait()
        show(sink, frame)

    def sleep(seconds):
        began.wait()
        ServedClock.sleep(counted, seconds)
        if counted.now() > 0.96:
            over.set()

    counted.sleep = sleep
    monkeypatch.setattr(FilmSink, "show", slowly)
    words = ("--osc", "127.0.0.1:0", "--record", path, "--duration", "0.99", "--fps", "20", "--size", "96x64")
    result = call(*words)
    assert result.exit_code == 0, result.output
    told = re.search(rf"{path}: (\d+) of (\d+) frames are left out, .*--every-frame", result.stderr)
    assert told.groups() == ("18", "20"), "the face was stepped all the same"
    assert times(path) == pytest.approx([0.0, 0.95], abs=1e-4)


@pytest.mark.gl
def test_it_films_every_frame_when_drawing_waits(tmp_path, counted):
    path = tmp_path / "film.mp4"
    result = call(
        *("--osc", "127.0.0.1:0", "--record", path, "--every-frame"),
        *("--duration", "0.99", "--fps", "20", "--size", "96x64"),
    )
    assert result.exit_code == 0, result.output
    assert times(path) == pytest.approx([frame / 20 for frame in range(20)], abs=1e-4), "none is left out"


@pytest.mark.parametrize(
    ("options", "goes_with"),
    [
        (["--size", "96x64"], "--record"),
        (["--view", "window", "--size", "96x64"], "--record"),
        (["--camera", "profile"], "--view window or --record"),
        (["--quality", "portrait"], "--view window or --record"),
        (["--look", "ginger"], "--view window, --record or --web"),
        (["--every-frame"], "--record"),
        (["--view", "window", "--fps", "30"], "--view none"),
        (["--view", "window", "--record", "a.mp4"], "--view none"),
        (["--view", "window", "--duration", "3"], "--view none"),
    ],
)
def test_what_would_do_nothing_is_refused(options, goes_with):
    assert f"{options[-2] if len(options) > 1 else options[-1]} goes with {goes_with}\n" in fail(*options, code=2)


def test_it_refuses_a_film_that_cannot_be_written(tmp_path):
    later = ("--osc", "127.0.0.1:0", "--every-frame")
    assert "no folder" in fail(*later, "--record", tmp_path / "no" / "a.mp4")
    assert "--record" in fail(*later, code=2)
    assert "no folder" in fail("--osc", "127.0.0.1:0", "--record", tmp_path / "no" / "a.mp4")
    assert ".mp4" in fail("--osc", "127.0.0.1:0", "--record", tmp_path / "a.avi")
    assert "even" in fail("--osc", "127.0.0.1:0", "--record", tmp_path / "a.mp4", "--size", "95x64")


TWO = ("--face", "amber", "--face", "onyx")


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--id", "left", "--id", "right"], "an --id for each --face or none, got 2 for 1"),
        ([*TWO, "--id", "left"], "an --id for each --face or none, got 1 for 2"),
        ([*TWO, "--id", "left", "--id", "left"], "'left' twice"),
        ([*TWO, "--view", "window"], "--view goes with one --face"),
        ([*TWO, "--record", "a.mp4"], "--record goes with one --face"),
        ([*TWO, "--look", "ginger"], "--look goes with one --face"),
        (["--face", "amber"] * 9, "at most 8 faces, got 9"),
    ],
)
def test_what_several_faces_do_not_have(options, told):
    assert told in fail(*options, code=2)


def test_an_id_is_not_the_name_of_a_message():
    assert "not the name of a message, got 'emotion'" in fail("--id", "emotion")


def test_the_same_face_twice_needs_ids():
    assert "'amber' twice; give each --face an --id" in fail("--face", "amber", "--face", "amber", code=2)


def test_one_face_under_an_id_says_so():
    result = call("--osc", "127.0.0.1:0", "--duration", "0.1", "--id", "host")
    assert result.exit_code == 0, result.output
    assert result.stdout.startswith("host (amber) listens to OSC on 127.0.0.1:")
