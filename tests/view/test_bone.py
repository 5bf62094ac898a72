"""The bone under the skin, as pictures show it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from agentface.deform.geometry import FaceGeometry
from agentface.view.parts.bone import Bone
from agentface.view.renderer import Renderer
from tests.heads import head_model

pytestmark = pytest.mark.gl

SIZE = (160, 180)
MODEL = head_model("amber")


@pytest.fixture(scope="module")
def renderer():
    with Renderer(MODEL) as renderer:
        yield renderer


@pytest.fixture
def face():
    return FaceGeometry.at_rest(MODEL)


def bone(deep_mm=8.0, tint=0.0):
    """A skull everywhere so deep under the skin."""
    points = (MODEL.vertices - 1e-3 * deep_mm * MODEL.normals).astype(np.float32)
    return Bone(points, MODEL.triangles, MODEL.jaw_weights, np.full(len(points), tint, np.float32))


def redness(picture):
    middle = picture[60:110, 60:100].astype(float)
    return float((middle[..., 0] - middle[..., 1:3].mean(axis=-1)).mean())


@pytest.mark.parametrize("quality", ["fast", "portrait"])
def test_bone_is_seen_through_the_skin_and_leaves_no_trace(renderer, face, quality):
    before = renderer.render(face, SIZE, quality=quality)
    through = renderer.render(face, SIZE, quality=quality, bone=bone())
    assert np.abs(before.astype(int) - through).mean() > 10
    assert redness(through) < 0.6 * redness(before), "bone is paler than skin"
    assert np.array_equal(renderer.render(face, SIZE, quality=quality), before)


def test_the_skin_is_a_film_round_it(renderer, face):
    shown = renderer.render(face, SIZE, alpha=True, bone=bone())[..., 3] / 255.0
    film = (shown > 0.05) & (shown < 0.95)
    assert 0.01 < film.mean() < 0.2
    deeper = renderer.render(face, SIZE, alpha=True, bone=bone(16.0))[..., 3] / 255.0
    assert ((deeper > 0.05) & (deeper < 0.95)).mean() > 1.3 * film.mean()


def test_tints_and_places_are_those_of_the_last_bone(renderer, face):
    plain = bone()
    pale = renderer.render(face, SIZE, bone=plain)
    amber, red = (
        renderer.render(face, SIZE, bone=plain._replace(tint=np.full(len(plain.points), tint, np.float32)))
        for tint in (0.5, 1.0)
    )
    assert redness(pale) + 10 < redness(amber) < redness(red) - 10
    outside = renderer.render(face, SIZE, bone=bone(-4.0, 1.0))
    assert redness(outside) > redness(red) + 5, "no film over what stands out of the skin"
    assert np.array_equal(renderer.render(face, SIZE, bone=plain), pale)


def test_the_jaw_opens_and_the_head_turns(renderer, face):
    closed = renderer.render(face, SIZE, bone=bone())
    angle = math.radians(20.0)
    pivot = np.array([*MODEL.jaw.pivot], np.float32)
    turn = np.array([[1, 0, 0], [0, math.cos(angle), -math.sin(angle)], [0, math.sin(angle), math.cos(angle)]])
    face.jaw[:3, :3], face.jaw[:3, 3] = turn, pivot - turn @ pivot
    changed = np.abs(renderer.render(face, SIZE, bone=bone()).astype(int) - closed).sum(axis=-1) > 30
    brow, chin = changed[:60], changed[110:150]
    assert not brow.any()
    assert chin.mean() > 0.05
    face.jaw[:] = np.eye(4)
    face.head[:3, :3] = turn
    assert (np.abs(renderer.render(face, SIZE, bone=bone()).astype(int) - closed).sum(axis=-1) > 30).mean() > 0.1
