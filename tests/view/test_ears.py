"""The ears' relief, and the lights that are too wide to shine on an edge of the skin alone."""

import numpy as np
import pytest

from agentface.head.look import load_look
from agentface.parameters import FacePose
from agentface.resources import face_names
from agentface.view.hair.brows import lash_line
from agentface.view.renderer import Renderer
from agentface.view.skin.complexion import blurred
from agentface.view.skin.ears import auricle, ear_light, sharp_ears
from tests.heads import deformer_of, head_model

each_face = pytest.mark.parametrize("face", face_names())


@each_face
def test_the_hollows_of_the_ears_are_dark_and_nothing_else(face):
    model = head_model(face)
    light, ear = ear_light(model), auricle(model)
    assert (light[ear == 0] == 1.0).all()
    assert light.min() > 0.0
    assert (light[ear == 1] < 0.6).any(), "the bowl"
    assert (light[ear == 1] > 0.99).any(), "the rim"


@each_face
def test_normals_are_sharper_at_the_ears_alone(face):
    model = head_model(face)
    sharp, soft = (blurred(model.normals, model.triangles, times) for times in (3, 14))
    mixed, ear = sharp_ears(model, sharp, soft), auricle(model)
    np.testing.assert_allclose(mixed[ear == 0], soft[ear == 0], atol=1e-6)
    np.testing.assert_allclose(mixed[ear == 1], sharp[ear == 1], atol=1e-6)
    np.testing.assert_allclose(np.linalg.norm(mixed, axis=1), 1.0, atol=1e-5)


@each_face
def test_lashes_darken_the_lids_alone_and_most_the_upper_ones(face):
    model = head_model(face)
    line = lash_line(model)
    lids = {int(v) for rings in model.eyelids.rings.values() for ring in rings for v in (*ring.upper, *ring.lower)}
    assert set(np.flatnonzero(line).tolist()) < lids
    lashes = model.eyelids.rings["l"][2]
    assert line[lashes.upper].min() > 2 * line[lashes.lower[1:-1]].max() > 0


@pytest.mark.gl
@pytest.mark.parametrize("quality", ["fast", "portrait"])
def test_wide_lights_shine_less_on_what_they_graze(quality):
    model = head_model("onyx")
    look, geometry, pictures = load_look(model), deformer_of("onyx").at(FacePose()), []
    for width in (0.0, 1.0):
        lights = look.lights.model_copy(update={"width": width})
        drawn = Renderer(model, look.model_copy(update={"lights": lights}))
        pictures.append(drawn.render(geometry, (240, 270), "front", quality).astype(int))
        drawn.close()
    narrow, wide = pictures
    assert (narrow - wide > 4).sum() > 300, "the edge from the temple to the jaw"
    assert not (wide - narrow > 4).any()
