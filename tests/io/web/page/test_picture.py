"""The page's picture beside the portrait, drawn by the same shaders in a browser."""

from __future__ import annotations

import base64
import io
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from PIL import Image
from playwright.sync_api import Browser, Page

from agentface.conventions import Bytes
from agentface.head.look import load_look
from agentface.io.web.head_file import encode_head
from agentface.view.camera import named_view
from agentface.view.renderer import Renderer
from tests.io.web.page.conftest import SIZE, opened
from tests.io.web.page.files import Files, exact_frame, no_basis, settled

pytestmark = [pytest.mark.slow, pytest.mark.gl, pytest.mark.untraced]

STAGE = "<!doctype html><title>stages</title>"
DRAW = """
async ({ url, frame, size, camera, transparent }) => {
  const { Face3D, Stage } = await import('/agentface.js');
  const stages = (window.stages ??= {}), name = `${url} ${transparent}`;
  if (!stages[name]) {
    stages[name] = new Stage(document.createElement('canvas'), { keep: true, transparent });
    stages[name].resize(...size, 1);
    stages[name].show(await Face3D.load(url));
  }
  const stage = stages[name], { skin, shirt } = stage.face;
  stage.look(camera);
  stage.face.show(frame);
  stage.draw();
  const picture = stage.renderer.domElement.toDataURL();
  const shoulders = Array.from(shirt.material.uniforms.moved.value);
  return { picture, shoulders, vertices: Array.from(skin.vertices), normals: Array.from(skin.normals) };
}
"""


@pytest.fixture(scope="module")
def stages(chromium: Browser, files: Files) -> Iterator[Page]:
    """A page that keeps the faces that it has drawn."""
    with opened(chromium) as page:
        page.goto(files.add("stage.html", STAGE))
        yield page


@pytest.fixture(scope="module")
def renderers() -> Iterator[dict[str, Renderer]]:
    made = {name: Renderer(settled(name)[0].model) for name in ("amber", "onyx")}
    yield made
    for renderer in made.values():
        renderer.close()


def drawn(tab: Page, files: Files, face: str, emotion: str | None, **options: Any) -> dict[str, Any]:
    """What the page makes of a face that has settled on an emotion."""
    model, geometry = settled(face)[0].model, settled(face, emotion)[1]
    asked = {"url": files.head(face), "frame": exact_frame(model, geometry), "size": SIZE, "camera": "front"}
    made: dict[str, Any] = tab.evaluate(DRAW, asked | {"transparent": False} | options)
    return made


def pixels(made: dict[str, Any]) -> Bytes:
    content = base64.b64decode(made["picture"].partition(",")[2])
    return np.asarray(Image.open(io.BytesIO(content)).convert("RGBA"))


def over_the_face(model: Any, camera: str) -> tuple[slice, slice]:
    """The box from the hairline to the chin, and from ear to ear."""
    view = named_view(model, camera)
    at = model.landmarks
    ahead = model.vertices[(model.vertices[:, 1] > at["menton"][1]) & (model.vertices[:, 1] < at["hairline_middle"][1])]
    seen = np.column_stack([ahead[ahead[:, 2] > 0.0], np.ones((ahead[:, 2] > 0.0).sum())])
    clip = seen @ (view.projection(SIZE[0] / SIZE[1]) @ view.view()).T
    x, y = (0.5 + 0.5 * clip[:, 0] / clip[:, 3]) * SIZE[0], (0.5 - 0.5 * clip[:, 1] / clip[:, 3]) * SIZE[1]
    return slice(int(y.min()), int(y.max()) + 1), slice(int(x.min()), int(x.max()) + 1)


@pytest.mark.parametrize(
    ("face", "emotion", "camera"),
    [
        ("amber", None, "front"),
        ("amber", "happiness", "three-quarter"),
        ("amber", "surprise", "front"),
        ("onyx", None, "profile"),
        ("onyx", "happiness", "front"),
        ("onyx", "surprise", "front"),
    ],
)
def test_page_draws_the_portrait(stages, files, renderers, face, emotion, camera):
    model, geometry = settled(face)[0].model, settled(face, emotion)[1]
    page = pixels(drawn(stages, files, face, emotion, camera=camera))[..., :3].astype(int)
    portrait = renderers[face].render(geometry, SIZE, camera, "portrait").astype(int)
    off = np.abs(page - portrait)
    box = over_the_face(model, camera)
    assert off[box].mean() < 2.0
    assert off.mean() < 2.0
    assert (off.max(axis=2) > 40).mean() < 0.01


def test_the_same_head_gives_the_same_bytes(files):
    model = settled("onyx")[0].model
    name = files.head("onyx").rpartition("/")[2]
    assert encode_head(model, load_look(model), no_basis(model)) == (files.folder / name).read_bytes()


def test_page_puts_skin_and_shoulders_where_the_engine_does(stages, files):
    geometry = settled("onyx", "surprise")[1]
    made = drawn(stages, files, "onyx", "surprise")
    assert np.abs(np.reshape(made["vertices"], (-1, 3)) - geometry.vertices).max() < 1e-6
    assert geometry.shoulders[1, 3] > 0.005
    np.testing.assert_allclose(np.reshape(made["shoulders"], (4, 4)).T, geometry.shoulders, atol=1e-6)
    facing = (np.reshape(made["normals"], (-1, 3)) * geometry.smooth_normals).sum(axis=1)
    assert np.abs(facing - 1.0).max() < 1e-4


def test_nothing_is_behind_a_transparent_face(stages, files):
    picture = pixels(drawn(stages, files, "amber", None, transparent=True))
    assert (picture[:20, :20] == 0).all()
    alpha = picture[..., 3]
    model = settled("amber")[0].model
    assert (alpha[over_the_face(model, "front")] == 255).mean() > 0.9
    # hair and shirt hide as much as skin does: little of the head is half clear, feathered tips of hair above all
    assert ((alpha > 0) & (alpha < 255)).sum() < 0.075 * (alpha == 255).sum()
