"""Looks are data: every one is read, drawn, and its faults are named together."""

from __future__ import annotations

import re
import shutil

import numpy as np
import pytest
import yaml
from click.testing import CliRunner

from agentface.cli import cli
from agentface.deform.pipeline import GeometricDeformer
from agentface.errors import DataError, UnknownNameError
from agentface.head.look import load_look, look_names, read_look
from agentface.head.model import load_model
from agentface.parameters import FacePose
from agentface.resources import face_folder, face_names
from agentface.view.gl.context import open_context
from agentface.view.renderer import Renderer

SIZE = (160, 180)
LOOKS = [(face, None) for face in face_names()] + [
    (face, path.stem) for face in face_names() for path in sorted(face_folder(face).glob("looks/*.yaml"))
]


@pytest.fixture(scope="module")
def context():
    return open_context()


def drawn(face, look, context, quality="fast", camera="front"):
    model = load_model(face)
    geometry = GeometricDeformer(model, compiled=False).at(FacePose())
    renderer = Renderer(model, load_look(model, look) if not hasattr(look, "hair") else look, context)
    return renderer.render(geometry, SIZE, camera, quality)


def changed(look, **values):
    return look.model_copy(update={"hair": look.hair.model_copy(update=values)})


def test_there_are_looks_of_other_skin_and_hair():
    assert len(LOOKS) >= len(face_names()) + 2
    read = [load_look(load_model(face), look) for face, look in LOOKS]
    assert len({tuple(look.skin.tone) for look in read}) == len(LOOKS)
    assert len({look.hair.style for look in read}) >= 4


@pytest.mark.slow
def test_every_look_is_drawn_and_shows_its_skin(context):
    seen: dict[str, dict[float, float]] = {}
    for face, name in LOOKS:
        look = load_look(load_model(face), name)
        forehead = drawn(face, name, context)[48:56, 75:85].reshape(-1, 3).mean(0)
        light = (forehead / 255) ** 2.2 / look.exposure
        assert light[0] > light[1] > light[2]
        seen.setdefault(face, {})[look.skin.tone[0]] = light[0]
    for tones in seen.values():  # under the same lights, the lighter the tone, the lighter the picture
        assert len(tones) > 1
        assert sorted(tones) == sorted(tones, key=lambda tone: tones[tone])


def test_looks_by_name_and_path_are_the_same(tmp_path):
    model = load_model("amber")
    name = look_names(model)[0]
    copy = shutil.copy(model.folder / "looks" / f"{name}.yaml", tmp_path / "mine.yaml")
    assert load_look(model, name) == load_look(model, copy) == load_look(model, str(copy))
    assert load_look(model) == read_look(model.folder / "look.yaml")


def test_an_unknown_look_is_told_with_the_known_ones():
    model = load_model("amber")
    with pytest.raises(UnknownNameError, match="ginger"):
        load_look(model, "nobody")


def test_all_faults_of_a_look_are_told_together(tmp_path):
    file = tmp_path / "look.yaml"
    data = yaml.safe_load((face_folder("amber") / "look.yaml").read_text())
    data["skin"]["tone"] = [0.5, 1.5, 0.2]
    data["hair"]["style"] = "mohawk"
    data["hair"]["volume"] = 9.0
    data["lights"]["key"]["strenght"] = 1.0
    del data["eyes"]["pupil"]
    file.write_text(yaml.safe_dump(data, sort_keys=False))
    with pytest.raises(DataError) as caught:
        read_look(file)
    told = str(caught.value)
    for part in ("skin.tone.1", "hair.style", "hair.volume", "lights.key.strenght", "eyes.pupil"):
        assert part in told
    lines = {fault.where: fault.line for fault in caught.value.faults}
    text = file.read_text().splitlines()
    assert "mohawk" in text[lines["hair.style"] - 1]


def test_a_light_needs_a_direction(tmp_path):
    file = tmp_path / "look.yaml"
    text = (face_folder("onyx") / "look.yaml").read_text()
    file.write_text(re.sub(r"towards: \[.*?\]", "towards: [0.0, 0.0, 0.0]", text, count=1))
    with pytest.raises(DataError, match=r"lights\.key\.towards"):
        read_look(file)


@pytest.mark.slow
def test_a_picture_repeats_to_the_byte(context):
    for quality in ("fast", "portrait"):
        first, again = (drawn("amber", "umber", context, quality) for _ in range(2))
        np.testing.assert_array_equal(first, again)


@pytest.mark.slow
def test_hair_changes_the_top_and_leaves_the_face(context):
    model = load_model("amber")
    own = load_look(model)
    bald = drawn("amber", changed(own, style="none"), context).astype(int)
    shown = np.zeros(SIZE[::-1], bool)
    for style in ("cropped", "swept", "bob", "bun"):
        apart = np.abs(drawn("amber", changed(own, style=style), context).astype(int) - bald).max(2)
        # eyes, nose and mouth
        assert apart[72:132, 64:95].max() <= 4, style  # hair keeps a little light off, and shades the cheeks beside it
        assert (apart[72:140, 57:104] > 20).mean() < 0.01, style
        assert (apart[19:33, 62:98] > 20).mean() > 0.5, style
        shown |= apart > 20
    assert shown.mean() > 0.1


@pytest.mark.slow
@pytest.mark.parametrize("value", [{"colour": [0.4, 0.2, 0.05]}, {"parting": 0.8}, {"length": 1.5}, {"volume": 1.8}])
def test_what_a_look_says_of_hair_is_seen(value, context):
    own = load_look(load_model("amber"))
    first, second = (drawn("amber", look, context).astype(int) for look in (own, changed(own, **value)))
    assert (np.abs(first - second).max(2) > 20).mean() > 0.005


@pytest.mark.slow
def test_the_command_takes_a_look(tmp_path):
    from PIL import Image

    pictures = []
    for more in ([], ["--look", "umber"], ["--look", str(face_folder("amber") / "looks" / "umber.yaml")]):
        file = tmp_path / f"{len(pictures)}.png"
        words = ["render", "--size", "96x108", "-o", str(file), *more]
        done = CliRunner().invoke(cli, words)
        assert done.exit_code == 0, done.output
        pictures.append(np.asarray(Image.open(file)))
    assert (pictures[0] != pictures[1]).any()
    np.testing.assert_array_equal(pictures[1], pictures[2])
