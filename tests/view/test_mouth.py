"""How much light the lips let into the mouth."""

import numpy as np
import pytest

from agentface.emotion.inference import default_inference
from agentface.emotion.state import EmotionState
from agentface.parameters import FacePose
from agentface.view.gl.context import open_context
from agentface.view.gl.programs import Programs
from agentface.view.parts.mouth import Mouth
from tests.heads import deformer_of, head_model

pytestmark = pytest.mark.gl
SHUT = 0.03


@pytest.fixture(scope="module", params=["amber", "onyx"])
def opening(request):
    context = open_context()
    mouth = Mouth(context, Programs(context, textured=False)["part"], head_model(request.param))
    yield lambda pose: mouth.opening(deformer_of(request.param).at(pose))
    context.release()


def test_lips_at_rest_and_pressed_lips_let_hardly_any_light_in(opening):
    for pose in (FacePose.of(), FacePose.of(orbicularis_oris_press=1.0)):
        assert opening(pose)["mouth_light"] == pytest.approx(SHUT, abs=0.02)


def test_the_wider_the_jaw_opens_the_more_light_comes_in(opening):
    light = [opening(FacePose.of(jaw_open=jaw))["mouth_light"] for jaw in np.linspace(0.0, 1.0, 9)]
    assert (np.diff(light) >= 0.0).all()
    assert light[-1] == 1.0


def test_lips_that_part_beside_the_middle_let_light_in(opening):
    """In disgust the lower lip bulges up to the upper one in the middle, and the teeth are bared beside it."""
    shown = opening(default_inference().pose(EmotionState.of({"disgust": 1.0})))
    upper, lower, half_width, _ = shown["mouth_opening"]
    assert shown["mouth_light"] > 0.15
    assert 0.001 < upper - lower < half_width
