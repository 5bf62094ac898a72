from __future__ import annotations

import numpy as np
import pytest

from agentface.deform.finish.neck import Neck, shares
from agentface.deform.pipeline import GeometricDeformer
from agentface.parameters import FacePose
from agentface.resources import face_names
from tests.heads import head_model


@pytest.mark.parametrize("face", face_names())
def test_the_face_turns_with_the_head_and_the_collar_stays(face):
    model = head_model(face)
    geometry = GeometricDeformer(model).deform(FacePose.of(head_yaw=0.5, head_pitch=-0.2, head_roll=0.2))
    vertices, normals = geometry.vertices.copy(), geometry.smooth_normals.copy()
    Neck(model).hold(geometry.head, vertices, normals)
    drawn = vertices @ geometry.head[:3, :3].T + geometry.head[:3, 3]
    turned = geometry.vertices @ geometry.head[:3, :3].T + geometry.head[:3, 3]
    share = shares(model)
    lips = [vertex for ring in model.lips.rings for vertex in ring.upper + ring.lower]
    np.testing.assert_array_equal(share[lips], 1.0)
    np.testing.assert_array_equal(drawn[lips], turned[lips])
    lowest = model.vertices[:, 1] < model.vertices[:, 1].min() + 0.005
    np.testing.assert_allclose(drawn[lowest], geometry.vertices[lowest], atol=0.003)
    mixed = share[:, None] * turned + (1 - share[:, None]) * geometry.vertices
    np.testing.assert_allclose(drawn, mixed, atol=1e-6)


def test_a_head_that_looks_ahead_leaves_the_skin_as_it_is():
    model = head_model("amber")
    vertices, normals = model.vertices.copy(), model.vertices.copy()
    Neck(model).hold(np.eye(4, dtype=np.float32), vertices, normals)
    np.testing.assert_array_equal(vertices, model.vertices)
