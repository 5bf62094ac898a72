"""Whatever ends a recording, a valid film of what was seen is left."""

from __future__ import annotations

import os
import pty
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest

from agentface.commands.ending import until_told

pytestmark = [pytest.mark.gl, pytest.mark.slow]
SERVE = (sys.executable, "-m", "agentface", "serve", "--osc", "127.0.0.1:0", "--size", "96x64", "--fps", "20")


def times(path: Path) -> list[float]:
    """The times of the frames of a film, all of which can be decoded."""
    import av

    with av.open(str(path)) as film:
        return [float(frame.time) for frame in film.decode(video=0)]


def recording(path: Path, *options: str, **streams) -> subprocess.Popen[str]:
    """A server that has begun to film."""
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True} | streams
    server = subprocess.Popen([*SERVE, "--record", str(path), *options], **streams)
    threading.Timer(280, server.kill).start()
    if server.stdout is not None:
        assert "listens to OSC" in server.stdout.readline()
    return server


@pytest.fixture(autouse=True)
def no_timer_is_left():
    yield
    for thread in threading.enumerate():
        if isinstance(thread, threading.Timer):
            thread.cancel()


def film(path: Path, seconds: float) -> None:
    """Wait until a server films for so long."""
    while not path.exists():
        time.sleep(0.01)
    time.sleep(seconds)


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
    with recording(path) as server:
        film(path, 0.7)
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
    with recording(path, "--every-frame", "--size", "640x360", "--fps", "120") as server:
        time.sleep(2.0)
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
        os.close(end)
        said = b""
        while b"listens to OSC" not in said:
            said += os.read(terminal, 1000)
        time.sleep(0.8)
        os.close(terminal)  # which sends SIGHUP; what is said from now on fails
        assert server.wait(240) == 0
    assert times(path)[-1] > 0.3


def test_a_process_that_is_killed_leaves_what_was_written(tmp_path):
    path = tmp_path / "a.mp4"
    with recording(path) as server:
        film(path, 3.0)
        server.kill()
    assert times(path)[-1] > 1.0


def test_a_reader_that_goes_away_ends_nothing(tmp_path):
    path = tmp_path / "a.mp4"
    with recording(path, "--duration", "0.6") as server:
        server.stdout.close()
        server.stderr.close()
        assert server.wait(240) == 0
    assert times(path)[-1] > 0.3


def test_a_disk_that_fills_keeps_the_recording_until_then(tmp_path):
    path = tmp_path / "a.mp4"
    limited = 'ulimit -f 40; exec "$0" "$@"'  # KiB
    command = ["bash", "-c", limited, *SERVE, "--size", "640x480", "--liveliness", "0", "--record", str(path)]
    command += ["--duration", "60"]  # a still face fills it slowly
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240)
    assert done.returncode == 1
    # the same limit keeps others, such as a cache or a measurement, from what they would write
    (said,) = [line for line in done.stderr.splitlines() if line.startswith("agentface: ")]
    until = float(re.fullmatch(rf"agentface: {path}: .*File too large; .*; it is kept up to (\d+\.\d) s", said)[1])
    seen = times(path)
    assert 20_000 < path.stat().st_size <= 40 * 1024
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
