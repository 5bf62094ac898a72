from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from agentface.deform.geometry import FaceGeometry
from agentface.parameters import FacePose
from tests.heads import deformer_of, head_model

SMILE = FacePose.of(zygomaticus_major=1.0, head_yaw=0.2)


def test_a_copy_is_equal_and_its_own():
    geometry = deformer_of().at(SMILE)
    for other in (geometry.copy(), copy.copy(geometry).copy(), copy.deepcopy(geometry)):
        assert other == geometry
        assert not any(np.shares_memory(*pair) for pair in zip(other.arrays(), geometry.arrays(), strict=True))
        other.vertices[7, 1] += 1e-6
        assert other != geometry
    assert geometry != "a face"


def test_a_geometry_is_pickled_and_not_hashed():
    geometry = deformer_of().at(SMILE)
    assert pickle.loads(pickle.dumps(geometry)) == geometry  # noqa: S301  # our own bytes
    with pytest.raises(TypeError, match="unhashable"):
        hash(geometry)


def test_leading_dimensions_are_faces():
    model = head_model()
    many = FaceGeometry.at_rest(model, batch=(3, 4))
    assert many.batch == (3, 4)
    assert len(many) == 3
    assert many.wrinkle_levels.shape == (3, 4, len(model.trains))
    assert many[1].batch == (4,)
    assert len(many[:2]) == 2
    many.vertices[:] = 0
    many[1][2].vertices[0] = 7
    assert many.vertices[1, 2, 0].tolist() == [7, 7, 7]
    assert np.count_nonzero(many.vertices) == 3
    assert all(array.flags.c_contiguous for array in many.arrays())


def test_one_face_is_no_sequence():
    geometry = deformer_of().at(SMILE)
    assert geometry.batch == ()
    with pytest.raises(TypeError, match="one face"):
        len(geometry)
    with pytest.raises(TypeError, match="one face"):
        geometry[0]
