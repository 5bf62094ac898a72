from __future__ import annotations

import numpy as np
import pytest

from agentface.agents import Drawing, VideoFrame
from agentface.agents.drawing import Painter
from agentface.deform.geometry import FaceGeometry
from agentface.errors import InvalidValueError, UnknownNameError
from tests.agents.speaking import speaker_of
from tests.heads import head_model
from tests.voices import talking_face


@pytest.mark.gl
def test_backgrounds():
    model = head_model()
    geometry, painter = FaceGeometry.at_rest(model), Painter(model)
    size = (96, 64)
    usual, clear, green = (
        painter.draw(geometry, Drawing(size, background=background))
        for background in ("look", "transparent", (0, 255, 0))
    )
    painter.close()
    painter.close()
    assert (usual.shape, clear.shape, green.shape) == ((64, 96, 3), (64, 96, 4), (64, 96, 3))
    assert clear[0, 0, 3] == 0
    assert green[0, 0].tolist() == [0, 255, 0]
    solid = clear[..., 3] == 255
    assert solid.mean() > 0.1
    assert np.array_equal(green[solid], clear[..., :3][solid])
    assert usual[0, 0].tolist() != [0, 255, 0]


@pytest.mark.gl
def test_a_speaker_gives_pictures_of_its_size():
    with talking_face() as face, speaker_of(face, Drawing((64, 48), background="transparent")) as speaker:
        frames = [piece for piece in speaker.take() if isinstance(piece, VideoFrame)]
    assert frames[0].image.shape == (48, 64, 4)
    assert frames[0].geometry is None
    assert frames[0].image[0, 0, 3] == 0


def test_a_speaker_that_does_not_draw_gives_geometry_of_its_own():
    with talking_face() as face, speaker_of(face) as speaker:
        first, second = (piece for _ in range(2) for piece in speaker.take() if isinstance(piece, VideoFrame))
    assert first.image is None
    assert first.geometry.vertices is not second.geometry.vertices


@pytest.mark.parametrize(
    "options",
    [{"size": (8, 64)}, {"size": (64, 5000)}, {"size": 64}, {"size": (64.0, 64)}, {"background": (1, 2)},
     {"background": (0, 0, 256)}, {"background": 5}],
)  # fmt: skip
def test_wrong_drawings_are_refused(options):
    with pytest.raises(InvalidValueError):
        Drawing(**options)


def test_an_unknown_background_is_told():
    with pytest.raises(UnknownNameError, match="transparent"):
        Drawing(background="transparant")
