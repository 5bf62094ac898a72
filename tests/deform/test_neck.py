from __future__ import annotations

import numpy as np
import pytest

from agentface.deform.finish import neck, neck_compiled
from agentface.parameters import FacePose
from agentface.resources import face_names
from tests.heads import deformer_of, head_model

TURNED = FacePose.of(head_yaw=0.5, head_pitch=-0.2, head_roll=0.2, jaw_open=0.3)


@pytest.mark.parametrize("face", face_names())
def test_the_face_turns_with_the_head_and_the_collar_stays(face):
    model = head_model(face)
    ahead = deformer_of(face).at(TURNED.replace({"head_yaw": 0.0, "head_pitch": 0.0, "head_roll": 0.0}))
    geometry = deformer_of(face).at(TURNED)
    drawn = geometry.vertices @ geometry.head[:3, :3].T + geometry.head[:3, 3]
    turned = ahead.vertices @ geometry.head[:3, :3].T + geometry.head[:3, 3]
    share = neck.shares(model)
    lips = [vertex for ring in model.lips.rings for vertex in ring.upper + ring.lower]
    np.testing.assert_array_equal(share[lips], 1.0)
    np.testing.assert_array_equal(geometry.vertices[lips], ahead.vertices[lips])
    lowest = model.vertices[:, 1] < model.vertices[:, 1].min() + 0.005
    assert lowest.any()
    np.testing.assert_allclose(drawn[lowest], ahead.vertices[lowest], atol=0.003)
    mixed = share[:, None] * turned + (1 - share[:, None]) * ahead.vertices
    np.testing.assert_allclose(drawn, mixed, atol=1e-6)


@pytest.mark.parametrize("apply", [neck.apply, neck_compiled.apply])
def test_a_head_that_looks_ahead_leaves_the_skin_as_it_is(apply):
    model = head_model("amber")
    fields = [model.vertices.copy() for _ in range(3)]
    apply(neck.prepare(model), np.eye(4, dtype=np.float32), *fields)
    for field in fields:
        np.testing.assert_array_equal(field, model.vertices)


def test_the_kernel_equals_its_numpy_twin_and_normals_stay_units():
    model = head_model("amber")
    turn, tables = deformer_of("amber").at(TURNED).head, neck.prepare(model)
    one, other = ([field.copy() for field in (model.vertices, model.normals, model.normals)] for _ in range(2))
    neck.apply(tables, turn, *one)
    neck_compiled.apply(tables, turn, *other)
    for expected, got in zip(one, other, strict=True):
        np.testing.assert_allclose(got, expected, atol=1e-6, rtol=0)
    assert not np.array_equal(one[1], model.normals)
    np.testing.assert_allclose(np.linalg.norm(one[1], axis=1), 1.0, atol=1e-6)
