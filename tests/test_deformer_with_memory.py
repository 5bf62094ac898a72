"""A deformer that a program adds, with a memory, behind everything that shows a face."""

from __future__ import annotations

from itertools import count

import numpy as np
import pytest
from click.testing import CliRunner

from agentface import Face
from agentface.cli import cli
from agentface.live.films import FilmSink
from agentface.resources import DEFAULT_FACE
from tests.clocks import ServedClock, send
from tests.deform import jelly
from tests.io.osc_bytes import message

pytestmark = [pytest.mark.gl, pytest.mark.slow, pytest.mark.untraced]
MOODS = """<emotionml version="1.0" xmlns="http://www.w3.org/2009/10/emotionml"
 category-set="http://www.w3.org/TR/emotion-voc/xml#big6">
<emotion duration="500"><category name="surprise"/></emotion></emotionml>"""


@pytest.fixture(autouse=True)
def registered():
    with jelly.registered():
        yield


@pytest.fixture
def filmed(monkeypatch):
    """The frames of the films that commands make."""
    frames, show = [], FilmSink.show

    def noted(sink, frame):
        frames.append(frame.copy())
        show(sink, frame)

    monkeypatch.setattr(FilmSink, "show", noted)
    return frames


def call(*arguments):
    result = CliRunner().invoke(cli, [*map(str, arguments), "--deformer", "jelly"], prog_name="agentface")
    assert result.exit_code == 0, result.output


def lags(frames):
    """How far each frame is, in metres at most, from what its pose alone would make."""
    still = jelly.Jelly(Face(DEFAULT_FACE).model)
    return [float(np.abs(still.at(frame.pose).vertices - frame.geometry.vertices).max()) for frame in frames]


def stepped(frames, step_s):
    """What a jelly shows that goes through the poses of ``frames``."""
    deformer = jelly.Jelly(Face(DEFAULT_FACE).model)
    for number, frame in enumerate(frames):
        yield deformer.step(frame.pose, step_s if number else 0.0).copy()


def test_a_still_picture_is_that_of_the_deformer_at_rest(tmp_path):
    from PIL import Image

    call("render", "--emotion", "surprise=1", "--size", "96x96", "-o", tmp_path / "a.png")
    face = Face(deformer="jelly", compiled=False)
    face.set_emotion("surprise", 1.0, fade=0.0)
    with Image.open(tmp_path / "a.png") as picture:
        np.testing.assert_array_equal(np.asarray(picture), face.render((96, 96)))


def test_play_films_what_it_remembers(tmp_path, filmed):
    (tmp_path / "moods.xml").write_text(MOODS)
    call("play", tmp_path / "moods.xml", "-o", tmp_path / "a.mp4", "--size", "64x64", "--fps", "25")
    assert len(filmed) == 19
    assert max(lags(filmed)) > 1e-3
    for frame, expected in zip(filmed, stepped(filmed, 1 / 25), strict=True):
        np.testing.assert_allclose(frame.geometry.vertices, expected.vertices, atol=1e-7)


@pytest.mark.parametrize("later", [False, True], ids=["live", "every-frame"])
def test_serve_films_what_it_remembers(tmp_path, filmed, later):
    waits = count(1)

    def agent(server):
        number = next(waits)
        if number % 3 == 0:
            send(server, message("/agentface/emotion", "sff", "surprise", number % 2, 0.0))

    with ServedClock(agent).at_work():
        call(
            *("serve", "--osc", "127.0.0.1:0", "--record", tmp_path / "a.mp4", "--duration", "1.17"),
            *("--size", "64x64", "--fps", "20", "--liveliness", "0", *(["--every-frame"] if later else [])),
        )
    assert max(lags(filmed)) > 1e-3
    if later:
        assert len(filmed) == 24
        for frame, expected in zip(filmed, stepped(filmed, 1 / 20), strict=True):
            np.testing.assert_allclose(frame.geometry.vertices, expected.vertices, atol=1e-7)
