from __future__ import annotations

import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.errors import GraphicsError
from agentface.face import Face
from tests.display import on_a_virtual_display
from tests.tools import require

HEAD = (
    '<emotionml version="1.0" xmlns="http://www.w3.org/2009/10/emotionml"'
    ' category-set="http://www.w3.org/TR/emotion-voc/xml#big6">'
)
SHORT = '<emotion duration="250"><category name="surprise"/></emotion>'
SMALL = ("--size", "64x64", "--fps", "10")


@pytest.fixture
def short(tmp_path):
    path = tmp_path / "short.xml"
    path.write_text(f"{HEAD}{SHORT}</emotionml>")
    return path


def call(*arguments):
    return CliRunner().invoke(cli, ["play", *map(str, arguments)], prog_name="agentface")


def fail(*arguments, code=1):
    result = call(*arguments)
    assert result.exit_code == code, result.output
    assert isinstance(result.exception, SystemExit)
    return result.stderr


def frames(path):
    import av

    with av.open(str(path)) as film:
        return [(float(frame.time), frame.to_ndarray(format="rgb24")) for frame in film.decode(video=0)]


@pytest.mark.slow
@pytest.mark.gl
def test_a_film_has_a_frame_at_every_step_and_is_the_same_twice(short, tmp_path):
    films = [tmp_path / f"{name}.mp4" for name in "ab"]
    for film in films:
        result = call(short, "-o", film, *SMALL)
        assert result.exit_code == 0, result.output
    shown = frames(films[0])
    assert [time for time, _ in shown] == pytest.approx([0.0, 0.1, 0.2, 0.3, 0.4], abs=1e-4)
    assert films[0].read_bytes() == films[1].read_bytes()


@pytest.mark.gl
def test_a_film_shows_what_the_document_says_from_neutral_to_neutral(monkeypatch, short, tmp_path):
    levels = []
    step = Face.step

    def noted(face, dt):
        geometry = step(face, dt)
        levels.append(face.status()["shown"]["emotion"]["surprise"])
        return geometry

    monkeypatch.setattr(Face, "step", noted)
    assert call(short, "-o", tmp_path / "a.mp4", "--size", "64x64", "--fps", "60").exit_code == 0
    assert len(levels) == len(frames(tmp_path / "a.mp4")) == 30
    assert levels[0] == 0.0
    assert max(levels) == levels[15] == 1.0, "a quarter of a second after its start the emotion is there"
    assert levels[-1] < 0.01


@pytest.mark.gl
def test_a_film_of_numbered_pictures_is_transparent(short, tmp_path):
    from PIL import Image

    result = call(short, "-o", tmp_path / "face-%03d.png", *SMALL, "--camera", "profile", "--look", "ginger")
    assert result.exit_code == 0, result.output
    names = sorted(path.name for path in tmp_path.glob("*.png"))
    assert names == [f"face-{number:03d}.png" for number in range(5)]
    with Image.open(tmp_path / names[0]) as picture:
        assert np.asarray(picture)[0, 0, 3] == 0


@pytest.mark.gl
@pytest.mark.parametrize("told", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP, "lost"])
def test_an_error_leaves_no_file_and_a_signal_what_was_filmed(monkeypatch, short, tmp_path, told):
    steps = iter([None, None, told])
    step = Face.step

    def failing(face, dt):
        if (failure := next(steps)) == "lost":
            raise GraphicsError(failure)
        if failure is not None:
            signal.raise_signal(failure)
            signal.raise_signal(failure)  # a second one, while it ends
        return step(face, dt)

    monkeypatch.setattr(Face, "step", failing)
    path = tmp_path / "a.mp4"
    said = fail(short, "-o", path, *SMALL, code=1 if told == "lost" else 128 + told)
    assert path.exists() == (told != "lost")
    if told == "lost":
        assert "lost" in said
    else:
        assert len(frames(path)) == 3
        assert f"{path}: stopped at 0.2 s of 0.5 s" in said


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"{HEAD}\n<emotion>\n<category name='joy'/></emotion></emotionml>", ":3: emotion 1.category joy: expected"),
        ("<emotionml>", ":1: expected well-formed XML"),
    ],
)  # fmt: skip
def test_a_document_with_faults_is_told_before_anything_is_done(tmp_path, text, message):
    path = tmp_path / "moods.xml"
    path.write_text(text)
    said = fail(path, "-o", tmp_path / "a.mp4")
    assert said.startswith(f"{path}:")
    assert message in said
    assert list(tmp_path.iterdir()) == [path]


def test_a_film_that_cannot_be_written(short, tmp_path):
    assert "no folder" in fail(short, "-o", tmp_path / "no" / "a.mp4")
    assert ".mp4" in fail(short, "-o", tmp_path / "a.avi")
    assert "even" in fail(short, "-o", tmp_path / "a.mp4", "--size", "63x64")
    assert "known: amber, onyx" in fail(short, "-o", tmp_path / "a.mp4", "--face", "nobody")
    assert list(tmp_path.iterdir()) == [short]


def test_other_files(tmp_path):
    assert "a readable file" in fail(tmp_path / "none.fap")
    assert "a readable file" in fail(tmp_path / "none.xml")


def test_usage(short, tmp_path):
    fail(code=2)
    assert "--fps goes with -o" in fail(short, "--fps", "30", code=2)
    assert "--size goes with -o" in fail(short, "--size", "64x64", code=2)
    assert "--loop goes without -o" in fail(short, "--loop", "-o", tmp_path / "a.mp4", code=2)
    fail(short, "--fps", "0", code=2)


RELEVANCE = (
    '<emotion duration="250" appraisal-set="http://www.w3.org/TR/emotion-voc/xml#scherer-appraisals">'
    '<appraisal name="relevance-person"/></emotion>'
)


@pytest.mark.parametrize(
    ("text", "note"),
    [(f"{HEAD}\n{RELEVANCE}</emotionml>", ":2: emotion 1.appraisal relevance-person: expected what the face shows"),
     (f"{HEAD}\n</emotionml>", ":1: expected at least one emotion, got none")],
)  # fmt: skip
def test_what_is_not_shown_is_a_note_and_with_strict_a_fault(tmp_path, text, note):
    path = tmp_path / "moods.xml"
    path.write_text(text)
    assert f"{path}{note}" in fail(path, "--strict", "-o", tmp_path / "a.mp4")
    check = CliRunner().invoke(cli, ["check", str(path)])
    assert (check.exit_code, check.stdout.splitlines()[0]) == (0, f"{path}: good")
    assert f"  note: {path}{note}" in check.stdout
    check = CliRunner().invoke(cli, ["check", "--strict", str(path)])
    assert (check.exit_code, check.stdout.splitlines()[0]) == (1, f"{path}: 1 fault")
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.gl
def test_a_document_of_which_nothing_is_shown_is_a_film_of_the_neutral_face(tmp_path):
    path = tmp_path / "moods.xml"
    path.write_text(f"{HEAD}\n{RELEVANCE}</emotionml>")
    result = call(path, "-o", tmp_path / "a.mp4", *SMALL)
    assert (result.exit_code, "note: " in result.stderr) == (0, True), result.output
    assert len(frames(tmp_path / "a.mp4")) == 5


def test_check_knows_emotionml(short, tmp_path):
    check = CliRunner().invoke(cli, ["check", str(short)])
    assert (check.exit_code, check.stdout) == (0, f"{short}: good\n")
    wrong = tmp_path / "wrong.xml"
    wrong.write_text(f"{HEAD}\n<emotion strat='1'><category name='joy'/></emotion></emotionml>")
    check = CliRunner().invoke(cli, ["check", str(wrong)])
    assert check.exit_code == 1
    assert f"{wrong}: 2 faults" in check.stdout
    assert f"{wrong}:2: emotion 1: expected no such attribute" in check.stdout


def without_a_display():
    return {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}


@pytest.mark.slow
def test_without_a_display_it_says_how_to_film(short):
    pytest.importorskip("glfw")
    command = [sys.executable, "-m", "agentface", "play", str(short)]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240, env=without_a_display())
    assert done.returncode == 1
    assert "expected a display" in done.stderr
    assert f"agentface play {short} -o FILE.mp4" in done.stderr
    assert "Traceback" not in done.stderr


WATCHED = """
import sys
from agentface.cli import cli
from agentface.face import Face

apply = Face.apply

def told(face, request):
    print({name: level for name, level in request.state.items() if level}, request.fade, flush=True)
    apply(face, request)

Face.apply = told
cli(["play", *sys.argv[1:]])
"""


@pytest.mark.untraced
@pytest.mark.gl
@pytest.mark.slow
def test_the_window_plays_the_document_and_closes(tmp_path):
    require("xvfb-run", "xauth")
    pytest.importorskip("glfw")
    path = tmp_path / "moods.xml"
    path.write_text(f"{HEAD}{SHORT.replace('250', '1500')}</emotionml>")
    command = [
        *on_a_virtual_display(),
        sys.executable,
        "-W",
        "error",
        "-c",
        WATCHED,
        str(path),
        "--camera",
        "profile",
    ]
    done = subprocess.run(command, check=False, capture_output=True, text=True, timeout=240, env=without_a_display())
    assert done.returncode == 0, done.stderr
    assert [line for line in done.stdout.splitlines() if "{" in line] == ["{'surprise': 1.0} 0.25", "{} 0.25"]
