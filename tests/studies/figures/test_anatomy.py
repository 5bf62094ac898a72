"""The pictures with labels: muscles, regions, rings; and what faces wear."""

from __future__ import annotations

from io import BytesIO

import numpy as np
import pytest
from PIL import Image

from agentface.face import Face
from agentface.head.model import load_model
from agentface.parameters import VECTOR_MUSCLES
from agentface.studies.figures import expressions, eyes, jaw, looks, muscles, overlay, regions, rings, tongue
from agentface.view.camera import Camera
from agentface.view.renderer import Renderer

pytestmark = [pytest.mark.gl, pytest.mark.slow]


@pytest.fixture
def written(monkeypatch):
    """The labels that are written, without their colours."""
    labels = []
    label = overlay.Canvas.label

    def noted(canvas, some, *, right, **options):
        labels.extend((each.text, each.at, right) for each in some)
        label(canvas, some, right=right, **options)

    monkeypatch.setattr(overlay.Canvas, "label", noted)
    return labels


def picture(png):
    with Image.open(BytesIO(png)) as image:
        return np.asarray(image.convert("RGB"), int)


def colours(drawn):
    return {tuple(colour) for colour in drawn.reshape(-1, 3)}


def test_every_vector_muscle_is_drawn_and_named_once(written, monkeypatch):
    monkeypatch.setattr(muscles, "_SIZE", (300, 400))
    drawn = picture(muscles.figures("amber")["muscles.png"])
    assert drawn.shape == (400, 300 + 2 * muscles._MARGIN, 3)
    names = [text.partition("  ")[0].replace(" ", "_") for text, _, _ in written]
    assert sorted(name for name in names if f"{name}_l" in VECTOR_MUSCLES) == sorted(
        name.removesuffix("_l") for name in VECTOR_MUSCLES if name.endswith("_l")
    )
    assert "zygomaticus major  AU 12" in [text for text, _, _ in written]
    assert all((x > overlay.FINER * drawn.shape[1] / 2) == right for _, (x, _), right in written)


def test_regions_are_coloured_where_they_are(written, monkeypatch):
    monkeypatch.setattr(regions, "_SIZE", (300, 380))
    drawn = picture(regions.figures("amber")["regions.png"])
    assert {text for text, _, _ in written} == set(regions._COLOURS)
    known = regions._COLOURS | {"bare skin": (200, 160, 130)}
    hues = np.array([np.array(colour) / sum(colour) for colour in known.values()])
    for text, at, _ in written:
        x, y = round(at[0] / overlay.FINER), round(at[1] / overlay.FINER)
        about = drawn[y - 6 : y + 7, x - 6 : x + 7].reshape(-1, 3) / 1.0
        about /= about.sum(axis=1, keepdims=True)
        nearest = {list(known)[i] for i in np.abs(about[:, None] - hues).sum(axis=2).argmin(axis=1)}
        assert text in nearest
    assert (drawn[0, 0] == 255).all(), "paper is white"


def test_named_rings_are_labelled_from_the_outside_in(written, monkeypatch):
    monkeypatch.setattr(rings, "_SIZE", (320, 260))
    drawn = rings.figures("amber")
    assert list(drawn) == ["lip-rings.png", "lid-rings.png"]
    heights = {text: at[1] for text, at, _ in written}
    lips = [heights[f"{member.name}  {member}"] for member in rings.LipRing]
    assert lips[rings.LipRing.SKIN - 4 :] == sorted(lips[rings.LipRing.SKIN - 4 :], reverse=True)
    assert heights["SKIN  8"] < heights["BORDER  7"] < heights["RED  4"] < heights["CONTACT  1"]
    assert heights["ORBIT  11"] < heights["CREASE  8"] < heights["EDGE  3"]


def test_a_canvas_puts_points_where_the_face_shows_them():
    model = load_model("amber")
    x, y, z = (float(value) for value in model.landmarks["pupil_l"])
    camera = Camera((x, y, z + 0.5), (x, y, z), 0.2)
    canvas = overlay.Canvas(Renderer(model), Face(model).geometry, camera, (90, 90), 40)
    middle, above = canvas.pixels(np.array([[x, y, z], [x, y + 0.01, z]]))
    np.testing.assert_allclose(middle, overlay.FINER * np.array([85, 45]))
    assert above[0] == pytest.approx(middle[0])
    assert above[1] < middle[1]
    assert canvas.image.getpixel(tuple(middle.astype(int))) < (90, 90, 90), "the pupil"


@pytest.mark.parametrize(
    ("wanted", "height", "rows"),
    [
        ([], 100, []),
        ([10, 50, 90], 100, [10, 50, 90]),
        ([50, 50, 50], 100, [40, 50, 60]),
        ([0, 1, 2], 100, [5, 15, 25]),
        ([99, 99], 100, [85, 95]),
        ([10, 12, 60], 100, [6, 16, 60]),
    ],
)
def test_labels_stand_apart_inside_the_picture_and_near_their_places(wanted, height, rows):
    assert overlay._spread(wanted, 10.0, height) == rows


def test_looks_and_styles_differ(monkeypatch):
    assert looks.STYLES == ("none", "cropped", "swept", "bob", "bun")
    monkeypatch.setattr(looks, "_SIZE", (64, 74))
    monkeypatch.setattr(looks, "STYLES", ("none", "bun"))
    monkeypatch.setattr(looks, "face_names", lambda: ("onyx",))
    drawn = looks.figures("onyx")
    for png, count in zip(drawn.values(), (2, 2), strict=True):
        cells = [picture(png)[12:86, 12 + 76 * i : 76 + 76 * i] for i in range(count)]
        assert all(np.abs(one - other).max() > 50 for i, one in enumerate(cells) for other in cells[:i])


@pytest.mark.parametrize(
    ("module", "sizes", "files"),
    [
        (expressions, {"_SIZE": (48, 56)}, ["emotional-faces.png"]),
        (eyes, {"_PAIR": (56, 25), "_SINGLE": (33, 29)}, ["eyelids.png", "squeeze.png"]),
        (jaw, {"_SIZE": (48, 56)}, ["jaw.png"]),
        (tongue, {"_SIZE": (48, 56)}, ["tongue.png"]),
    ],
)
def test_the_figures_of_the_paper_are_drawn(monkeypatch, module, sizes, files):
    for name, size in sizes.items():
        monkeypatch.setattr(module, name, size)
    drawn = module.figures("amber")
    assert list(drawn) == files
    assert all(len(colours(picture(png))) > 100 for png in drawn.values())
