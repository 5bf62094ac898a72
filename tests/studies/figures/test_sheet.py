from __future__ import annotations

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

from agentface import Face
from agentface.cli import cli
from agentface.view.contact_sheet import CAPTION, GAP, png, sheet

pytestmark = pytest.mark.gl


def call(*arguments, code=0):
    result = CliRunner().invoke(cli, ["sheet", *map(str, arguments)], prog_name="agentface")
    assert result.exit_code == code, result.output
    return result


def test_the_command_draws_the_emotions_it_is_told(tmp_path):
    path = tmp_path / "sheet.png"
    call("--emotions", "fear,joy", "--levels", "0.5,1", "--size", "64x72", "-o", path)
    with Image.open(path) as image:
        assert image.size == (2 * (64 + GAP) + GAP, 2 * (72 + CAPTION + GAP) + GAP)
        cells = [np.asarray(image.crop((x, y, x + 64, y + 72)), int) for y in (GAP, GAP + 136) for x in (GAP, GAP + 76)]
    assert all(np.abs(one - other).max() > 20 for i, one in enumerate(cells) for other in cells[:i])


@pytest.mark.slow
def test_a_pose_mixes_emotions_and_muscles(tmp_path):
    both, muscle = tmp_path / "both.png", tmp_path / "muscle.png"
    call("--pose", "wow: surprise=0.5, jaw_open=0.9", "--size", "64x72", "-o", both)
    call("--pose", "wow: jaw_open=0.9", "--size", "64x72", "-o", muscle)
    assert both.read_bytes() != muscle.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "said", "code"),
    [
        (["--pose", "a: smirk=1"], "'smirk'", 1),
        (["--pose", "a: fear"], "expected NAME=V", 2),
        (["--emotions", "hunger"], "'hunger'", 1),
        (["--levels", "high"], "0.25,0.5,1", 2),
        (["--levels", "1.5"], "1.5", 1),
        (["--size", "4000x4000"], "megapixels", 1),
    ],
)
def test_what_is_wrong_is_said_and_nothing_written(tmp_path, arguments, said, code):
    assert said in call(*arguments, "-o", tmp_path / "x.png", code=code).output
    assert not list(tmp_path.iterdir())


def test_panels_of_a_sheet_lie_where_they_belong_and_keep_their_pixels():
    colours = [(200, 30, 30), (30, 200, 30), (30, 30, 200)]
    panels = [(np.full((20, 30, 3), colour, np.uint8), "title", "note") for colour in colours]
    image = sheet(panels, columns=2)
    assert image.size == (2 * 42 + GAP, 2 * (20 + CAPTION + GAP) + GAP)
    places = [(GAP, GAP), (GAP + 42, GAP), (GAP, GAP + 20 + CAPTION + GAP)]
    assert [image.getpixel((x + 29, y + 19)) for x, y in places] == colours
    assert png(image).startswith(b"\x89PNG")


@pytest.mark.slow
def test_an_emotion_on_a_sheet_is_the_one_that_the_face_shows(tmp_path):
    """The sides of a face differ in what they make of an emotion, here as elsewhere; a muscle by name is as asked."""
    path, face = tmp_path / "sheet.png", Face()
    call("--pose", "a: fear=1, nasalis=0.6", "--size", "64x72", "-o", path)
    face.set_emotion("fear", 1.0, fade=0.0)
    face.set_muscle("nasalis", 0.6, fade=0.0)
    face.step(0.0)
    with Image.open(path) as image:
        np.testing.assert_array_equal(np.asarray(image.crop((GAP, GAP, GAP + 64, GAP + 72))), face.render((64, 72)))
