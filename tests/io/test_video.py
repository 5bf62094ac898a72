from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from agentface.errors import InvalidValueError, OutputError
from agentface.io.video import VideoWriter

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


def film_until(path: Path, error: BaseException) -> None:
    with VideoWriter(path, SIZE) as video:
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
    assert subprocess.run([sys.executable, "-c", script, str(path)], check=False, timeout=60).returncode == 9
    assert len(read(path)) >= 30


def test_no_frames_no_file(tmp_path):
    with VideoWriter(tmp_path / "a.mp4", SIZE):
        pass
    assert not (tmp_path / "a.mp4").exists()


def test_bad_frames_and_sizes(tmp_path):
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
