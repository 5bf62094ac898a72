"""A breath lifts what is below the neck, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.deform.finish import chest, chest_compiled
from agentface.deform.geometry import FaceArrays
from agentface.parameters import FacePose
from agentface.resources import face_names
from agentface.view.parts.shirt import shirt
from tests.heads import deformer_of, head_model


@given(st.floats(0, 1, width=32))
def test_the_kernel_equals_its_numpy_twin(breath):
    tables, values = chest.prepare(head_model()), FacePose.of(breath=breath).array
    first, second = np.full((2, 4, 4), np.nan, np.float32)
    chest.apply(tables, values, first)
    chest_compiled.apply(tables, values, second)
    np.testing.assert_allclose(first, second, atol=1e-7)


@pytest.mark.parametrize("face", face_names())
def test_it_lifts_the_shoulders_and_widens_the_chest_and_moves_no_skin(face):
    deformer = deformer_of(face, compiled=False)
    rest = deformer.at(FacePose()).copy()
    full = deformer.at(FacePose.of(breath=1.0))
    for name, before, now in zip(FaceArrays._fields, rest.arrays(), full.arrays(), strict=True):
        assert np.array_equal(before, now) == (name != "shoulders"), name
    np.testing.assert_array_equal(rest.shoulders, np.eye(4))
    cloth = shirt(head_model(face))[0]
    moved = cloth @ full.shoulders[:3, :3].T + full.shoulders[:3, 3] - cloth
    assert moved[:, 1] == pytest.approx(0.008, abs=1e-6)
    outward = np.sign(cloth[:, 0]) * moved[:, 0]
    assert outward.min() >= 0.0
    assert 0.001 < outward.max() < 0.005
    assert moved[cloth[:, 2].argmax(), 2] > 0.001
    assert np.linalg.norm(moved, axis=1).max() < 0.012
