"""Every expression on both faces in both qualities, and the examples, against pictures that were looked at."""

from __future__ import annotations

from importlib.util import module_from_spec, spec_from_file_location
from itertools import product
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from agentface import EMOTIONS, Face
from agentface.resources import face_names
from agentface.view.gl.context import open_context
from agentface.view.gl.quality import QUALITIES
from tests.view.compare import FOLDER, Goldens, difference, reduced

EXAMPLES = Path(__file__).parents[2] / "examples"
SIZE = (236, 264)


@pytest.fixture(scope="session")
def driver():
    context = open_context()
    name = context.info["GL_RENDERER"]
    context.release()
    return name


@pytest.fixture
def goldens(request, driver, tmp_path):
    if not driver.startswith("llvmpipe"):
        pytest.skip(f"the pictures are llvmpipe's, and every driver rounds its own way; this one is {driver}")
    goldens = Goldens(tmp_path / "off", regenerate=request.config.getoption("--regen-goldens"))
    yield goldens
    goldens.check()


@pytest.mark.gl
@pytest.mark.parametrize("quality", QUALITIES)
@pytest.mark.parametrize("name", face_names())
def test_expressions_look_as_they_did(goldens, name, quality):
    face = Face(name)
    for expression in ("neutral", *EMOTIONS):
        face.set_emotion({} if expression == "neutral" else {expression: 1.0}, fade=0.0)
        goldens.compare(f"{name}-{quality}-{expression}", face.render(SIZE, quality=quality))


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.gl
@pytest.mark.parametrize("name", face_names())
def test_expressions_of_tissue_look_as_they_did(goldens, name):
    face = Face(name, deformer="tissue")
    for expression in EMOTIONS:
        face.set_emotion({expression: 1.0}, fade=0.0)
        goldens.compare(f"{name}-tissue-{expression}", face.render(SIZE, quality="portrait"))


def example(name: str):
    spec = spec_from_file_location(name, EXAMPLES / f"{name}.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.slow
@pytest.mark.gl
def test_the_sheet_of_the_demo_looks_as_it_did(goldens, tmp_path):
    example("make_demo").draw_expressions(tmp_path / "expressions.png")
    with Image.open(tmp_path / "expressions.png") as image:
        goldens.compare("example-make_demo", reduced(image, 4))


@pytest.mark.slow
@pytest.mark.gl
def test_the_picture_of_set_emotion_looks_as_it_did(goldens, tmp_path, monkeypatch):
    monkeypatch.setattr("sys.argv", ["set_emotion.py", "fear", "0.9", str(tmp_path / "fear.png")])
    example("set_emotion").main()
    with Image.open(tmp_path / "fear.png") as image:
        goldens.compare("example-set_emotion", reduced(image, 4))


class Frames(list):
    """Stands for a film, whose own pictures every version of the codec makes a little different."""

    def add(self, image: np.ndarray, _: float) -> None:
        self.append(image)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        return None


@pytest.mark.slow
@pytest.mark.gl
def test_the_film_of_moods_looks_as_it_did(goldens, tmp_path, monkeypatch):
    frames, moods = Frames(), example("moods")
    monkeypatch.setattr(moods, "VideoWriter", lambda *_: frames)
    monkeypatch.setattr("sys.argv", ["moods.py", str(tmp_path / "moods.mp4"), "--seconds", "0.8", "--size", "96"])
    moods.main()
    assert len(frames) == 24
    goldens.compare("example-moods", np.hstack(frames[2::7]))


@pytest.mark.parametrize(
    ("level", "count", "fails"), [(2, 10_000, False), (3, 10, False), (3, 11, True), (255, 11, True)]
)
def test_what_counts_as_different(level, count, fails):
    expected = np.zeros((100, 100, 3), np.uint8)
    actual = expected.copy()
    actual.reshape(-1, 3)[:count, 1] = level
    assert bool(difference(actual, expected)) == fails
    assert bool(difference(expected, actual)) == fails


def test_a_failure_shows_what_differs(tmp_path):
    expected, actual = np.full((2, 8, 6, 3), 50, np.uint8)
    actual[2, 3] = 60
    Goldens(tmp_path, folder=tmp_path / "stored", regenerate=True).compare("a", expected)
    goldens = Goldens(tmp_path / "off", folder=tmp_path / "stored")
    goldens.compare("a", expected)
    goldens.check()
    assert not list((tmp_path / "off").iterdir())
    goldens.compare("a", actual)
    goldens.compare("a", actual[:4])
    goldens.compare("b", actual)
    message = rf"(?s)a: 2\.08% .*by 10\n.*shape.*\nb: no such golden.*{tmp_path / 'off'}.*--regen-goldens"
    with pytest.raises(AssertionError, match=message):
        goldens.check()
    written = {path.name for path in (tmp_path / "off").iterdir()}
    assert written == {"a-actual.png", "a-expected.png", "a-difference.png", "b-actual.png"}
    difference_seen = np.asarray(Image.open(tmp_path / "off" / "a-difference.png"))
    assert difference_seen[2, 3].tolist() == [80, 80, 80]
    assert difference_seen.sum() == 240


def test_no_golden_is_left_over_and_all_are_small():
    drawn = {f"example-{name}" for name in ("make_demo", "set_emotion", "moods")}
    drawn |= {"-".join(each) for each in product(face_names(), QUALITIES, ("neutral", *EMOTIONS))}
    drawn |= {f"{name}-tissue-{expression}" for name, expression in product(face_names(), EMOTIONS)}
    stored = list(FOLDER.iterdir())
    assert {path.stem for path in stored} == drawn
    assert sum(path.stat().st_size for path in stored) < 3e6
