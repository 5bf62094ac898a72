"""Whatever ends a recording, a valid film of what was seen is left."""

from __future__ import annotations

import contextlib
import os
import pty
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from agentface.commands.ending import until_told
from tests.io.osc_bytes import message
from tests.waiting import until

pytestmark = [pytest.mark.gl, pytest.mark.slow, pytest.mark.untraced]
SERVE = (sys.executable, "-m", "agentface", "serve", "--osc", "127.0.0.1:0", "--size", "96x64", "--fps", "20")


def times(path: Path) -> list[float]:
    """The times of the frames of a film, all of which can be decoded."""
    import av

    with av.open(str(path)) as film:
        return [float(frame.time) for frame in film.decode(video=0)]


def recording(path: Path, *options: str) -> tuple[subprocess.Popen[str], int]:
    """A server that has begun to film, and its port."""
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    server = subprocess.Popen([*SERVE, "--record", str(path), *options], **streams)
    threading.Timer(280, server.kill).start()
    return server, port_in(server.stdout.readline())


def port_in(said: str) -> int:
    return int(re.search(r"listens to OSC on 127\.0\.0\.1:(\d+)", said)[1])


@pytest.fixture(autouse=True)
def no_timer_is_left():
    yield
    for thread in threading.enumerate():
        if isinstance(thread, threading.Timer):
            thread.cancel()


def frames(port: int, count: int) -> None:
    """Wait for so many of a server's frames: it answers in each, and they are its frame's time apart at least."""
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as client:
        client.settimeout(30)
        for _ in range(count):
            until(lambda: answered(client, port))


def answered(client: socket.socket, port: int) -> bool:
    """Whether a server says how its face is, within the time that the client waits."""
    client.sendto(message("/agentface/status"), ("127.0.0.1", port))
    with contextlib.suppress(TimeoutError):
        return bool(client.recv(65536))
    return False


def written_s(path: Path) -> float:
    """Until when a film that is being written could be played now."""
    try:
        return times(path)[-1]
    except (OSError, ValueError, IndexError):  # of which PyAV's errors are kinds
        return 0.0


@pytest.mark.parametrize(
    "told",
    [
        [signal.SIGHUP],
        [signal.SIGINT, signal.SIGINT],
        [signal.SIGQUIT, signal.SIGTERM, signal.SIGINT, signal.SIGINT],
    ],
    ids=lambda told: "-".join(kind.name for kind in told),
)
def test_signals_while_it_films(tmp_path, told):
    path = tmp_path / "a.mp4"
    server, port = recording(path)
    with server:
        frames(port, 10)
        for kind in told:
            server.send_signal(kind)
        _, said = server.communicate(timeout=240)
    assert server.returncode == 0, said
    assert "Traceback" not in said
    seen = times(path)
    assert seen == sorted(set(seen))
    assert seen[-1] > 0.3


def test_a_second_signal_ends_the_drawing_of_what_was_noted(tmp_path):
    path, told = tmp_path / "a.mp4", signal.SIGINT
    # much is left to be drawn when a part is
    server, port = recording(path, "--every-frame", "--size", "640x360", "--fps", "120", "--quality", "portrait")
    with server:
        frames(port, 120)
        server.send_signal(told)
        while not path.exists() or path.stat().st_size < 2000:
            time.sleep(0.01)
            assert server.poll() is None, server.stderr.read()
        server.send_signal(told)
        server.send_signal(told)
        _, said = server.communicate(timeout=240)
    assert server.returncode == 128 + told
    stopped, whole = map(float, re.search(rf"{path}: stopped at (\d\.\d) s of (\d\.\d) s", said).groups())
    seen = times(path)
    assert seen == pytest.approx([frame / 120 for frame in range(len(seen))], abs=1e-4)
    assert seen[-1] == pytest.approx(stopped, abs=0.051)
    assert stopped < whole


@pytest.mark.parametrize("options", [[], ["--every-frame"]], ids=["live", "every-frame"])
def test_a_terminal_that_is_closed(tmp_path, options):
    path = tmp_path / "a.mp4"
    terminal, end = pty.openpty()
    command = ["setsid", "--ctty", *SERVE, "--record", str(path), *options]
    with subprocess.Popen(command, stdin=end, stdout=end, stderr=end) as server:
        threading.Timer(280, server.kill).start()
        os.close(end)
        said = b""
        while not said.endswith(b"\n"):
            said += os.read(terminal, 1000)
        frames(port_in(said.decode()), 10)
        os.close(terminal)  # which sends SIGHUP; what is said from now on fails
        assert server.wait(240) == 0
    assert times(path)[-1] > 0.3


def test_a_process_that_is_killed_leaves_what_was_written(tmp_path):
    path = tmp_path / "a.mp4"
    server, _ = recording(path)
    with server:
        until(lambda: written_s(path) > 1.0, lambda: time.sleep(0.2))
        server.kill()
    assert times(path)[-1] > 1.0


def test_a_reader_that_goes_away_ends_nothing(tmp_path):
    path = tmp_path / "a.mp4"
    server, port = recording(path)
    with server:
        server.stdout.close()
        server.stderr.close()
        frames(port, 10)
        server.send_signal(signal.SIGINT)
        assert server.wait(240) == 0
    assert times(path)[-1] > 0.3


def test_a_disk_that_fills_keeps_the_recording_until_then(tmp_path):
    path = tmp_path / "a.mp4"
    limited = 'ulimit -f 100; exec "$0" "$@"'  # KiB
    command = ["bash", "-c", limited, *SERVE, "--size", "640x480", "--liveliness", "0", "--record", str(path)]
    command += ["--duration", "200"]  # every second begins with a picture of some 50 KiB
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240)
    assert done.returncode == 1
    # the same limit keeps others, such as a cache or a measurement, from what they would write
    (said,) = [line for line in done.stderr.splitlines() if line.startswith("agentface: ")]
    until = float(re.fullmatch(rf"agentface: {path}: .*File too large; .*; it is kept up to (\d+\.\d) s", said)[1])
    seen = times(path)
    assert 20_000 < path.stat().st_size <= 100 * 1024
    assert seen[-1] < until < seen[-1] + 0.3


def test_what_is_ignored_stays_ignored_and_every_signal_counts():
    before, term = signal.signal(signal.SIGHUP, signal.SIG_IGN), signal.getsignal(signal.SIGTERM)
    try:
        with until_told() as ending:
            signal.raise_signal(signal.SIGHUP)
            assert (ending.told(), ending.signal) == (False, None), "as nohup has it"
            signal.raise_signal(signal.SIGTERM)
            assert (ending.told(), ending.code) == (True, 143)
            ending.go_on()
            assert not ending.told()
            signal.raise_signal(signal.SIGINT)
            assert (ending.told(), ending.code) == (True, 130)
        assert signal.getsignal(signal.SIGTERM) is term
        assert signal.getsignal(signal.SIGHUP) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGHUP, before)
