"""Normals near wrinkles are renewed, the others taken over: the same as to compute them all."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform.finish import smooth_normals, wrinkle_normals, wrinkles
from agentface.deform.finish import wrinkle_normals_compiled as compiled
from agentface.mesh.normals import vertex_normals
from tests.heads import head_model

MODEL = head_model("amber")
WRINKLES = wrinkles.prepare(MODEL)
TABLES = wrinkle_normals.prepare(smooth_normals.prepare(MODEL), WRINKLES)


def shaded(module, heights):
    smooth = vertex_normals(MODEL.vertices, MODEL.triangles).astype(np.float32)
    vertices = MODEL.vertices + heights[:, None] * smooth
    out = np.full_like(vertices, np.nan)
    module.apply(TABLES, heights, vertices, smooth, out)
    return vertices, smooth, out


@settings(max_examples=20)
@given(st.integers(0, 2**32), st.floats(0, 0.002))
def test_both_forms_are_the_normals_of_the_whole_raised_skin(seed, height):
    heights = np.zeros(len(MODEL.vertices), np.float32)
    heights[TABLES.raised] = height * np.random.default_rng(seed).random(len(TABLES.raised), np.float32)
    vertices, _, numpy_form = shaded(wrinkle_normals, heights)
    expected = vertex_normals(vertices, MODEL.triangles)
    np.testing.assert_allclose(numpy_form, expected, atol=1e-6)
    # single precision, of the narrowest triangles
    np.testing.assert_allclose(shaded(compiled, heights)[2], expected, atol=5e-4)


@pytest.mark.parametrize("module", [wrinkle_normals, compiled])
def test_where_nothing_rises_the_normals_stay_bit_for_bit(module):
    _, smooth, out = shaded(module, np.zeros(len(MODEL.vertices), np.float32))
    np.testing.assert_array_equal(out, smooth)


@pytest.mark.parametrize("module", [wrinkle_normals, compiled])
def test_normals_far_from_what_rises_stay_bit_for_bit(module):
    heights = np.zeros(len(MODEL.vertices), np.float32)
    heights[TABLES.raised] = 1e-3
    _, smooth, out = shaded(module, heights)
    far = np.setdiff1d(np.arange(len(smooth)), TABLES.near)
    np.testing.assert_array_equal(out[far], smooth[far])
    assert set(WRINKLES.vertices.tolist()) == set(TABLES.raised.tolist()) <= set(TABLES.near.tolist())
