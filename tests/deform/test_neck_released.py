"""A neck that is released is moved by linear blend skinning, which is all that other programs know."""

from __future__ import annotations

import numpy as np
import pytest

from agentface.deform.finish import neck
from agentface.parameters import FacePose
from tests.heads import deformer_of, head_model

TURNS = [
    {"head_yaw": 0.0},
    {"head_yaw": 1.2},
    {"head_pitch": -0.9, "head_roll": 0.4},
    {"head_yaw": -1.3, "head_pitch": 0.9, "head_roll": -0.8},
]


@pytest.mark.parametrize("turn", TURNS)
@pytest.mark.parametrize("face", ["amber", "onyx"])
def test_it_is_the_face_whose_head_is_not_turned(face, turn):
    model, deformer = head_model(face), deformer_of(face)
    shown = {"zygomaticus_major_l": 0.7, "jaw_open": 0.4}
    turned, straight = deformer.at(FacePose.of(**shown, **turn)), deformer.at(FacePose.of(**shown))
    tables = neck.prepare(model)
    vertices, normals = neck.released(tables, turned.head, turned.vertices, turned.normals)
    np.testing.assert_allclose(vertices, straight.vertices, atol=2e-6)
    np.testing.assert_allclose(normals, straight.normals, atol=2e-3)


def test_blending_the_head_s_turn_and_none_gives_the_neck_back():
    model, deformer = head_model("amber"), deformer_of("amber")
    turned = deformer.at(FacePose.of(head_yaw=0.8, head_roll=0.3))
    free, _ = neck.released(neck.prepare(model), turned.head, turned.vertices, turned.normals)
    share = neck.shares(model)[:, None]
    whole = free @ turned.head[:3, :3].T + turned.head[:3, 3]
    in_the_room = turned.vertices @ turned.head[:3, :3].T + turned.head[:3, 3]
    np.testing.assert_allclose(share * whole + (1.0 - share) * free, in_the_room, atol=2e-6)
