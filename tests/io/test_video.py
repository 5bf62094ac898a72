from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
from hashlib import sha256
from pathlib import Path

import numpy as np
import pytest

from agentface.errors import InvalidValueError, OutputError
from agentface.io.video import VideoWriter, whole_fragments

SIZE = (64, 48)


def picture(level: int) -> np.ndarray:
    return np.full((SIZE[1], SIZE[0], 3), level, np.uint8)


def read(path: Path) -> list[tuple[float, float]]:
    """Time and mean brightness of each frame."""
    import av

    with av.open(str(path)) as container:
        stream = container.streams.video[0]
        assert stream.codec_context.name == "h264"
        assert (stream.width, stream.height) == SIZE
        return [
            (float(frame.time), float(frame.to_ndarray(format="gray").mean())) for frame in container.decode(stream)
        ]


def film_until(path: Path, error: BaseException, *, keep: bool = False) -> None:
    with VideoWriter(path, SIZE, keep=keep) as video:
        video.add(picture(1), 0.0)
        raise error


def test_frames_stand_at_their_times(tmp_path):
    times = [0.0, 0.1, 0.15, 0.9, 2.0]
    with VideoWriter(tmp_path / "a.mp4", SIZE, 30) as video:
        for number, time in enumerate(times):
            video.add(picture(50 * number), time)
    seen = read(tmp_path / "a.mp4")
    assert [time for time, _ in seen] == pytest.approx(times, abs=1e-4)
    assert np.diff([level for _, level in seen]).min() > 30


@pytest.mark.parametrize("times", [(0.5,), (0.4, 0.5, 0.9)])
def test_one_that_begins_late_shows_its_first_frame_until_then(tmp_path, times):
    with VideoWriter(tmp_path / "a.mp4", SIZE, 30) as video:
        for number, time in enumerate(times):
            video.add(picture(50 * (number + 1)), time)
    seen = read(tmp_path / "a.mp4")
    assert [time for time, _ in seen] == pytest.approx([0.0, *times], abs=1e-4)
    assert seen[0][1] == pytest.approx(seen[1][1], abs=1.0)


def test_an_error_removes_the_file(tmp_path):
    path = tmp_path / "a.mp4"
    with pytest.raises(RuntimeError):
        film_until(path, RuntimeError())
    assert not path.exists()


def test_an_interrupt_keeps_what_was_filmed(tmp_path):
    path = tmp_path / "a.mp4"
    with pytest.raises(KeyboardInterrupt):
        film_until(path, KeyboardInterrupt())
    assert len(read(path)) == 1


def test_a_killed_process_leaves_a_file_that_plays(tmp_path):
    path = tmp_path / "a.mp4"
    script = (
        "import numpy as np, os, sys; from pathlib import Path; from agentface.io.video import VideoWriter\n"
        f"video = VideoWriter(Path(sys.argv[1]), {SIZE}, 30)\n"
        f"for i in range(120): video.add(np.full(({SIZE[1]}, {SIZE[0]}, 3), i, np.uint8), i / 30)\n"
        "os._exit(9)"
    )
    assert subprocess.run([sys.executable, "-c", script, str(path)], check=False, timeout=240).returncode == 9
    assert len(read(path)) >= 30


NOISE = (
    "import numpy as np, os, sys; from pathlib import Path; from agentface.io.video import VideoWriter\n"
    "os.sched_setaffinity(0, sorted(os.sched_getaffinity(0))[: int(sys.argv[2])])\n"
    f"with VideoWriter(Path(sys.argv[1]), {SIZE}) as video:\n"
    "    for i in range(70):\n"
    f"        video.add(np.random.default_rng(i).integers(0, 255, ({SIZE[1]}, {SIZE[0]}, 3), np.uint8), i / 30)"
)


@pytest.mark.slow
def test_the_same_frames_give_the_same_bytes_on_any_number_of_cores(tmp_path):
    contents = []
    for name, cores in (("a", 99), ("b", 99), ("c", 1)):
        path = tmp_path / f"{name}.mp4"
        subprocess.run([sys.executable, "-c", NOISE, str(path), str(cores)], check=True, timeout=240)
        contents.append(path.read_bytes())
    assert contents[0] == contents[1] == contents[2]
    assert len(read(path)) == 70


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.parametrize("name", ["film.mp4", "face-%03d.png"])
def test_the_same_poses_give_the_same_files(tmp_path, name):
    from agentface import Face
    from agentface.io.sequence import SequenceWriter

    contents = []
    for take in ("a", "b"):
        (tmp_path / take).mkdir()
        face, transparent = Face(), name.endswith(".png")
        with (SequenceWriter if transparent else VideoWriter)(tmp_path / take / name, (96, 96), 10) as film:
            face.set_emotion("surprise", 1.0, fade=0.6)
            for frame in range(6):
                film.add(face.render((96, 96), alpha=transparent), frame / 10)
                face.step(0.1)
        files = sorted((tmp_path / take).iterdir())
        contents.append([(path.name, sha256(path.read_bytes()).digest()) for path in files])
    assert contents[0] == contents[1]
    assert len({content for _, content in contents[0]}) >= (5 if transparent else 1), "the face moves"


def serve_later(path: Path, seconds: float, size: str) -> subprocess.Popen:
    """A recording whose frames are drawn at its end, on what it takes for a terminal."""
    command = [sys.executable, "-m", "agentface", "serve", "--osc", "127.0.0.1:0", "--every-frame", "--record", path]
    options = ["--duration", str(seconds), "--fps", "60", "--size", size]
    terminal = os.environ | {"FORCE_COLOR": "1", "COLUMNS": "80", "PYTHONUNBUFFERED": "1"}
    return subprocess.Popen(
        [*map(str, command), *options], env=terminal, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
    )


@pytest.mark.slow
@pytest.mark.gl
def test_drawing_later_tells_the_time_left(tmp_path):
    with serve_later(tmp_path / "film.mp4", 0.5, "64x48") as server:
        _, said = server.communicate(timeout=240)
    assert server.returncode == 0, said
    shares = [int(share) for share in re.findall(r"(\d+)%", said)]
    assert shares == sorted(shares)
    assert shares[-1] == 100
    assert re.search(r"film\.mp4", said)
    assert re.search(r"\d:\d\d:\d\d", said)
    assert read(tmp_path / "film.mp4")


@pytest.mark.slow
@pytest.mark.gl
@pytest.mark.parametrize("name", ["film.mp4", "face-%05d.png"])
def test_an_interrupt_while_drawing_keeps_what_is_drawn(tmp_path, name):
    with serve_later(tmp_path / name, 1.5, "1280x720") as server:
        said = ""
        while not re.search(r"\s[1-9]\d?%", said[-5:]):
            said += server.stderr.read(1)
            assert server.poll() is None, said
        server.send_signal(signal.SIGINT)
        server.communicate(timeout=240)
    assert server.returncode != 0
    if name == "film.mp4":
        import av

        with av.open(str(tmp_path / name)) as film:
            count = sum(1 for _ in film.decode(video=0))
    else:
        from PIL import Image

        paths = sorted(tmp_path.iterdir())
        assert [path.name for path in paths] == [f"face-{number:05d}.png" for number in range(len(paths))]
        count = len([Image.open(path).load() for path in paths])
    assert 0 < count < 90


@pytest.mark.slow
def test_a_full_disk_is_told_and_nothing_is_left(tmp_path):
    """The last write is the one that FFmpeg keeps to itself."""
    whole = tmp_path / "whole.mp4"
    subprocess.run([sys.executable, "-c", NOISE, str(whole), "99"], check=True, timeout=240)
    limited = "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]),) * 2)\n" + NOISE
    for limit in (500, whole.stat().st_size // 2, whole.stat().st_size - 1):
        path = tmp_path / f"{limit}.mp4"
        command = [sys.executable, "-c", limited, str(path), "99", str(limit)]
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240)
        assert f"OutputError: {path}: expected to write it, got: File too large" in done.stderr
        assert not path.exists()


def test_a_full_disk_keeps_the_whole_part_of_a_live_recording_and_says_up_to_where(tmp_path):
    whole = tmp_path / "whole.mp4"
    subprocess.run([sys.executable, "-c", NOISE, str(whole), "99"], check=True, timeout=240)
    everything = read(whole)
    limited = "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[3]),) * 2)\n"
    limited += NOISE.replace(f"{SIZE})", f"{SIZE}, keep=True)")
    for limit in (whole.stat().st_size // 2, whole.stat().st_size - 1):
        path = tmp_path / f"{limit}.mp4"
        command = [sys.executable, "-c", limited, str(path), "99", str(limit)]
        done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240)
        until = float(re.search(r"File too large; .*; it is kept up to (\d+\.\d) s", done.stderr)[1])
        kept = read(path)
        assert kept == everything[: len(kept)]
        assert kept[-1][0] + 1 / 30 == pytest.approx(until, abs=0.051)
        assert until > limit / whole.stat().st_size * everything[-1][0] - 1.0, "most of what was written"
        with path.open("rb") as file:
            assert whole_fragments(file) == path.stat().st_size
    command = [sys.executable, "-c", limited, str(tmp_path / "b.mp4"), "99", "900"]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240)
    assert "nothing of it could be kept" in done.stderr
    assert not (tmp_path / "b.mp4").exists()


def test_an_error_keeps_a_live_recording(tmp_path):
    with pytest.raises(RuntimeError):
        film_until(tmp_path / "a.mp4", RuntimeError(), keep=True)
    assert len(read(tmp_path / "a.mp4")) == 1


def test_no_frames_no_file(tmp_path):
    with VideoWriter(tmp_path / "a.mp4", SIZE):
        pass
    assert not (tmp_path / "a.mp4").exists()


def test_bad_frames_sizes_and_rates(tmp_path):
    for fps in (0, -1, float("nan"), 1e6):
        with pytest.raises(InvalidValueError, match="fps"):
            VideoWriter(tmp_path / "a.mp4", SIZE, fps)
    with pytest.raises(InvalidValueError, match="even"):
        VideoWriter(tmp_path / "a.mp4", (63, 48))
    with VideoWriter(tmp_path / "a.mp4", SIZE) as video:
        video.add(picture(1), 0.5)
        for time in (0.5, 0.4, float("nan")):
            with pytest.raises(InvalidValueError, match="time_s"):
                video.add(picture(1), time)
        with pytest.raises(InvalidValueError, match="shape"):
            video.add(picture(1)[:10], 1.0)


@pytest.mark.parametrize("name", ["missing/a.mp4", "a.txt", "a"])
def test_places_that_cannot_be_written(tmp_path, name):
    with pytest.raises(OutputError, match=name.split("/")[0]):
        VideoWriter(tmp_path / name, SIZE)
    assert not list(tmp_path.iterdir())
