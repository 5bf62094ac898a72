from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from agentface.errors import InvalidValueError, OutputError
from agentface.io.files import write_file
from agentface.io.sequence import SequenceWriter

SIZE = (6, 4)


def picture(level: int, channels: int = 4) -> np.ndarray:
    image = np.full((SIZE[1], SIZE[0], channels), level, np.uint8)
    image[0, :, -1] = 0
    return image


def read(folder: Path) -> dict[str, np.ndarray]:
    return {path.name: np.asarray(Image.open(path)) for path in sorted(folder.iterdir())}


def film(path: Path, times: list[float], fps: float = 10) -> None:
    with SequenceWriter(path, SIZE, fps) as frames:
        for number, at in enumerate(times):
            frames.add(picture(10 * number + 10), at)


def film_until(path: Path, error: BaseException, *, keep: bool = False) -> None:
    with SequenceWriter(path, SIZE, 10, keep=keep) as frames:
        for number in range(3):
            frames.add(picture(number), number / 10)
        raise error


@pytest.mark.parametrize(
    ("times", "levels"),
    [
        ([0.0, 0.1, 0.2], [10, 20, 30]),
        ([0.001, 0.104, 0.197], [10, 20, 30]),
        ([0.0, 0.4], [10, 10, 10, 10, 20]),
        ([0.0, 0.06, 0.13], [10, 30]),
        ([0.2], [10, 10, 10]),
        ([], []),
    ],
)
def test_file_n_shows_what_is_seen_at_n_steps(tmp_path, times, levels):
    film(tmp_path / "a-%05d.png", times)
    seen = read(tmp_path)
    assert list(seen) == [f"a-{number:05d}.png" for number in range(len(levels))]
    for image, level in zip(seen.values(), levels, strict=True):
        np.testing.assert_array_equal(image, picture(level))


def test_the_same_frames_give_the_same_bytes(tmp_path):
    contents = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        film(tmp_path / name / "%03d.png", [0.0, 0.1, 0.5])
        contents.append([path.read_bytes() for path in sorted((tmp_path / name).iterdir())])
    assert contents[0] == contents[1]
    assert len(contents[0]) == 6


def test_opaque_pictures_are_taken_too(tmp_path):
    with SequenceWriter(tmp_path / "%01d.png", SIZE, 10) as frames:
        for number in range(11):
            frames.add(picture(number, 3), number / 10)
    assert read(tmp_path)["10.png"].shape == (4, 6, 3)


def test_an_error_removes_what_was_written_and_nothing_else(tmp_path):
    (tmp_path / "other-00000.png").write_bytes(b"")
    with pytest.raises(RuntimeError):
        film_until(tmp_path / "a-%05d.png", RuntimeError())
    assert [path.name for path in tmp_path.iterdir()] == ["other-00000.png"]


def test_an_interrupt_keeps_what_was_filmed(tmp_path):
    with pytest.raises(KeyboardInterrupt):
        film_until(tmp_path / "a-%05d.png", KeyboardInterrupt())
    assert len(read(tmp_path)) == 3


def test_a_live_recording_keeps_its_files_when_something_fails(tmp_path, monkeypatch):
    with pytest.raises(RuntimeError):
        film_until(tmp_path / "a-%05d.png", RuntimeError(), keep=True)
    assert len(read(tmp_path)) == 3

    def full(path, content):
        if path.name == "b-00002.png":
            raise OutputError(f"{path}: no space")
        write_file(path, content)

    monkeypatch.setattr("agentface.io.sequence.write_file", full)
    with pytest.raises(OutputError, match=r"no space; the 2 files before it are kept"):
        film_until(tmp_path / "b-%05d.png", KeyboardInterrupt(), keep=True)
    assert [path.name for path in sorted(tmp_path.glob("b*"))] == ["b-00000.png", "b-00001.png"]


def test_a_killed_process_leaves_whole_files(tmp_path):
    script = (
        "import numpy as np, sys; from pathlib import Path; from agentface.io.sequence import SequenceWriter\n"
        "frames = SequenceWriter(Path(sys.argv[1]), (300, 300), 10)\n"
        "for i in range(10**6): frames.add(np.random.default_rng(i).integers(0, 255, (300, 300, 4), np.uint8), i / 10)"
    )
    with subprocess.Popen([sys.executable, "-c", script, str(tmp_path / "%06d.png")], env=os.environ) as process:
        while not (tmp_path / "000003.png").exists():
            assert process.poll() is None
            time.sleep(0.01)
        process.send_signal(signal.SIGKILL)
    for path in tmp_path.glob("[0-9]*.png"):  # what was being written has another name
        with Image.open(path) as image:
            image.load()


def test_files_of_another_take_are_not_mixed_in(tmp_path):
    film(tmp_path / "a-%05d.png", [0.0, 0.3])
    for name in ("a-%05d.png", "a-%03d.png"):
        with pytest.raises(OutputError, match=r"got 4 \(a-00000\.png"):
            SequenceWriter(tmp_path / name, SIZE)
    film(tmp_path / "b-%05d.png", [0.0])


@pytest.mark.parametrize("name", ["a.png", "a-%d.png", "a-%05d.jpg", "%05d-%05d.png", "100%-%05d.png", "a-%00d.png"])
def test_names_without_one_place_for_the_number(tmp_path, name):
    with pytest.raises(OutputError, match=r"%05d\.png"):
        SequenceWriter(tmp_path / name, SIZE)


def test_places_that_cannot_be_written(tmp_path):
    with pytest.raises(OutputError, match="make it first"):
        SequenceWriter(tmp_path / "no" / "a-%05d.png", SIZE)


def test_bad_frames_and_rates(tmp_path):
    with pytest.raises(InvalidValueError, match="fps"):
        SequenceWriter(tmp_path / "a-%05d.png", SIZE, 0)
    with SequenceWriter(tmp_path / "a-%05d.png", SIZE) as frames:
        frames.add(picture(1), 0.5)
        for at in (0.5, 0.4, -1.0, float("nan")):
            with pytest.raises(InvalidValueError, match="time_s"):
                frames.add(picture(1), at)
        with pytest.raises(InvalidValueError, match="shape"):
            frames.add(picture(1)[:2], 1.0)
