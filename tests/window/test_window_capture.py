import errno
from datetime import datetime

import numpy as np
import pytest

from agentface.errors import OutputError
from agentface.io.picture import write_picture
from agentface.io.video import VideoWriter
from agentface.window.capture import Capture

NOON = datetime(2030, 5, 4, 12, 0, 7)


@pytest.fixture
def said():
    return []


@pytest.fixture
def capture(tmp_path, said):
    return Capture(write_picture, VideoWriter, said.append, tmp_path, lambda: NOON)


def grey(size):
    width, height = size
    return np.full((height, width, 3), 90, np.uint8)


def never(size):
    raise AssertionError("no picture is wanted")


def test_a_picture_is_written_once_and_never_over_another(capture, tmp_path, said):
    from PIL import Image

    capture.frame(0.0, (40, 30), never)
    for _ in range(2):
        capture.picture_wanted = True
        capture.frame(1.0, (40, 30), grey)
        capture.frame(1.1, (40, 30), never)
    first, second = sorted(tmp_path.iterdir(), key=lambda path: len(path.name))
    assert (first.name, second.name) == ("agentface-20300504-120007.png", "agentface-20300504-120007-2.png")
    with Image.open(first) as picture:
        assert picture.size == (40, 30)
    assert said == [f"wrote {first}", f"wrote {second}"]
    assert capture.message == f"wrote {second.name} in {tmp_path}"


def test_a_film_keeps_its_size_and_its_times(capture, tmp_path, said):
    import av

    capture.film_wanted = True
    for frame in range(60):  # more often than a film takes frames
        capture.frame(5.0 + frame / 60, (41, 31) if frame < 30 else (80, 60), grey)
    assert capture.filmed_s == pytest.approx(59 / 60, abs=1 / 30)
    capture.film_wanted = False
    capture.frame(6.0, (80, 60), never)
    assert capture.filmed_s is None
    (path,) = tmp_path.iterdir()
    assert path.name == "agentface-20300504-120007.mp4"
    with av.open(str(path)) as film:
        frames = list(film.decode(video=0))
    assert (frames[0].width, frames[0].height, len(frames)) == (40, 30, 30)
    assert float(frames[-1].time) == pytest.approx(58 / 60, abs=0.01)
    assert str(path) in said[-1]


def test_closing_in_the_middle_leaves_a_valid_film(capture, tmp_path):
    import av

    capture.film_wanted = True
    for frame in range(5):
        capture.frame(frame / 10, (64, 48), grey)
    capture.close()
    capture.close()
    with av.open(str(next(tmp_path.iterdir()))) as film:
        assert len(list(film.decode(video=0))) == 5


def test_a_folder_that_is_gone_is_told_and_the_show_goes_on(tmp_path, said):
    capture = Capture(write_picture, VideoWriter, said.append, tmp_path / "gone", lambda: NOON)
    capture.picture_wanted = capture.film_wanted = True
    capture.frame(0.0, (40, 30), grey)
    assert "no folder" in capture.message
    assert [message.partition(":")[2].startswith(" expected a file") for message in said] == [True, True]
    assert not capture.picture_wanted
    assert not capture.film_wanted
    capture.frame(0.1, (40, 30), never)


class Full:
    """A film that fails with its third frame."""

    def __init__(self, path, size, fps):
        self.frames, self.closed = 0, 0
        Full.last = self

    def add(self, image, time_s):
        self.frames += 1
        if self.frames == 3:
            raise OutputError(f"film: cannot be written: {errno.errorcode[errno.ENOSPC]}")

    def close(self):
        self.closed += 1


def test_a_full_disk_ends_the_film_and_not_the_show(tmp_path, said):
    capture = Capture(write_picture, Full, said.append, tmp_path, lambda: NOON)
    capture.film_wanted = True
    for frame in range(3):
        capture.frame(float(frame), (40, 30), grey)
    assert "ENOSPC" in said[-1]
    assert Full.last.closed == 1, "it keeps what it has"
    assert capture.filmed_s is None
    capture.frame(4.0, (40, 30), never)


def test_a_picture_that_cannot_be_written_does_not_end_the_film(tmp_path, said):
    def fails(path, image):
        raise OutputError(f"{path}: the disk is full")

    capture = Capture(fails, VideoWriter, said.append, tmp_path, lambda: NOON)
    capture.film_wanted = True
    for frame in range(6):
        capture.picture_wanted = frame == 3
        capture.frame(frame / 10, (40, 30), grey)
    assert capture.filmed_s == pytest.approx(0.5)
    capture.close()
    assert sum("the disk is full" in message for message in said) == 1
    assert len(list(tmp_path.glob("*.mp4"))) == 1
