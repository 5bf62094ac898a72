import dataclasses
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from agentface.deform.lanes import LANES
from agentface.deform.muscles.blocks import pack, slacks
from agentface.deform.muscles.combine import METHODS, REFERENCE, STEP, Combiner
from agentface.deform.muscles.vector_muscle import pull
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.muscle_set import FALLOFFS, MuscleSet
from tests.deform.rig import make_rig

COUNT = 38
CONTRACTIONS = arrays(np.float64, COUNT, elements=st.one_of(st.just(0.0), st.just(1.0), st.floats(0.0, 1.0)))


@cache
def rig(falloff="smooth"):
    return make_rig(falloff=falloff)


@cache
def combiner(method, falloff="smooth"):
    return Combiner(rig(falloff).vertices, rig(falloff).muscles, method)


def apply(method, contractions, falloff="smooth"):
    out = np.full_like(rig().vertices, np.nan)
    combiner(method, falloff).apply(contractions, out)
    return out


@pytest.mark.parametrize("method", METHODS)
def test_the_neutral_face_is_the_rest_face_bit_for_bit(method):
    assert apply(method, np.zeros(COUNT)).tobytes() == rig().vertices.tobytes()


@pytest.mark.parametrize("method", METHODS)
@settings(max_examples=25, deadline=None)
@given(contractions=CONTRACTIONS)
def test_the_kernel_equals_its_numpy_twin(method, contractions):
    expected = REFERENCE[method](rig().vertices, rig().muscles, contractions)
    assert np.abs(apply(method, contractions) - expected).max() < 1e-6


def test_the_kernel_equals_its_numpy_twin_across_the_cliffs_of_waters():
    draw = np.random.default_rng(7)
    face = rig("waters")
    for _ in range(5):
        contractions = draw.random(COUNT) * (draw.random(COUNT) < 0.4)
        for method in METHODS:
            expected = REFERENCE[method](face.vertices, face.muscles, contractions)
            gap = np.abs(apply(method, contractions, "waters") - expected).max(axis=1)
            # a vertex within rounding of a cliff may fall to either side
            assert np.count_nonzero(gap > 1e-6) <= 2


@pytest.mark.parametrize("falloff", FALLOFFS)
def test_blocks_leave_out_no_vertex_that_some_contractions_move(falloff):
    face = rig(falloff)
    packed = pack(face.vertices, face.muscles)
    assert packed.vertex.shape[1] == LANES
    draw = np.random.default_rng(3)
    for method in METHODS:
        moved = REFERENCE[method](face.vertices, face.muscles, draw.random(COUNT)) != face.vertices
        assert set(np.flatnonzero(moved.any(axis=1))) <= set(packed.vertex.ravel())


@settings(max_examples=20, deadline=None)
@given(seed=st.integers(0, 2**31), falloff=st.sampled_from(FALLOFFS))
def test_a_vertex_that_travels_less_than_its_slack_stays_out_of_the_zone(seed, falloff):
    face = rig(falloff)
    apart = slacks(face.vertices, face.muscles)
    way = np.random.default_rng(seed).normal(size=face.vertices.shape)
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    for muscle in range(COUNT):
        outside = np.isfinite(apart[muscle]) & (apart[muscle] > 0.0)
        travelled = face.vertices + way * np.where(outside, apart[muscle], 0.0)[:, None]
        assert not pull(face.muscles, muscle, travelled, 1.0)[outside].any()


def test_a_slack_is_as_long_as_the_way_to_the_zone_is():
    points, muscles = two_muscles()
    apart = slacks(points, muscles)
    inside = [pull(muscles, muscle, points, 1.0).any(axis=1) for muscle in range(2)]
    assert ((apart == 0.0) == inside).all()
    tail = points[0, 1] - 0.01
    below = np.array([[-0.004, tail, 0.0]], np.float32)
    far = dataclasses.replace(muscles, reach=np.ones((2, 1), np.float32))
    assert slacks(below, far)[0, 0] == pytest.approx(0.05 - tail - 0.06, abs=2e-6)


@settings(max_examples=20, deadline=None)
@given(contractions=CONTRACTIONS)
def test_the_face_is_finite_and_no_vertex_goes_further_than_its_muscles_together(contractions):
    muscles = rig().muscles
    bound = (contractions * muscles.elasticity) @ muscles.reach
    for method in METHODS:
        moved = apply(method, contractions)
        assert np.isfinite(moved).all()
        assert (np.linalg.norm(moved - rig().vertices, axis=1) <= bound + 1e-6).all()


@settings(max_examples=20, deadline=None)
@given(contractions=CONTRACTIONS)
def test_mirrored_contractions_give_the_mirrored_face(contractions):
    swapped = contractions.reshape(-1, 2)[:, ::-1].ravel()
    columns = 40
    index = np.arange(len(rig().vertices)).reshape(-1, columns)[:, ::-1].ravel()
    mirrored = apply("parallel", swapped)[index] * [-1, 1, 1]
    assert np.abs(apply("parallel", contractions) - mirrored).max() < 1e-6


@settings(max_examples=20, deadline=None)
@given(muscle=st.integers(0, COUNT - 1), contraction=st.floats(0.0, STEP))
def test_one_muscle_within_one_step_is_the_same_however_combined(muscle, contraction):
    contractions = np.zeros(COUNT)
    contractions[muscle] = contraction
    one, two, three = (apply(method, contractions) for method in METHODS)
    assert np.abs(one - two).max() < 1e-8
    assert np.abs(one - three).max() < 1e-8


def test_nothing_moves_where_no_muscle_reaches():
    muscles = rig().muscles
    outside = muscles.reach.max(axis=0) == 0.0
    moved = apply("parallel", np.ones(COUNT))
    assert outside.any()
    assert moved[outside].tobytes() == rig().vertices[outside].tobytes()
    none = dataclasses.replace(muscles, reach=np.zeros_like(muscles.reach))
    out = np.empty_like(moved)
    Combiner(rig().vertices, none).apply(np.ones(COUNT), out)
    assert out.tobytes() == rig().vertices.tobytes()


OTHERS = 2000
"""Vertices at the end of the rig that belong to muscles of another kind."""


def found_by(method, contractions, shares, *, compiled=True):
    face, found = rig(), np.full((OTHERS, shares.shape[1]), np.nan, np.float32)
    out = np.empty_like(face.vertices)
    by = combiner(method) if compiled else Combiner(face.vertices, face.muscles, method, compiled=False)
    by.apply(contractions, out, np.ascontiguousarray(shares, np.float32), found)
    return found, out[-OTHERS:, 0]


@settings(max_examples=15, deadline=None)
@given(contractions=CONTRACTIONS, step=st.integers(0, 5))
def test_what_acts_in_a_step_finds_the_vertices_where_the_steps_before_have_brought_them(contractions, step):
    shares = np.zeros((6, 2))
    shares[step, 0] = 1.0
    shares[:, 1] = [0.1, 0.2, 0.0, 0.3, 0.15, 0.25]
    found, end = found_by("parallel", contractions, shares)
    ways = [REFERENCE["parallel"](rig().vertices, rig().muscles, np.minimum(contractions, k * STEP)) for k in range(6)]
    there = np.stack([way[-OTHERS:, 0] for way in ways])
    np.testing.assert_allclose(found, (shares.T @ there).T, atol=1e-6)
    np.testing.assert_allclose(there[-1], end, atol=1e-6)
    twin, _ = found_by("parallel", contractions, shares, compiled=False)
    np.testing.assert_allclose(found, twin, atol=1e-6)


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("compiled", [True, False])
def test_what_acts_after_the_last_step_finds_the_vertices_where_they_end(method, compiled):
    shares = np.zeros((combiner(method).steps + 1, 1))
    shares[-1] = 1.0
    found, end = found_by(method, np.linspace(0, 1, COUNT), shares, compiled=compiled)
    assert np.abs(found[:, 0] - rig().vertices[-OTHERS:, 0]).max() > 1e-3
    np.testing.assert_allclose(found[:, 0], end, atol=1e-7)


def two_muscles():
    """Two muscles side by side that pull the same vertices up, and the row of vertices between them."""
    points = np.column_stack([np.zeros(50), np.linspace(-0.02, 0.045, 50), np.zeros(50)]).astype(np.float32)
    muscles = MuscleSet(
        names=["a", "b"],
        origin=[[-0.004, 0.05, 0], [0.004, 0.05, 0]],
        insertion=[[-0.004, 0.0, 0], [0.004, 0.0, 0]],
        zone=[0.7, 0.7],
        fall_start=[0.02, 0.02],
        fall_finish=[0.06, 0.06],
        elasticity=[0.03, 0.03],
        reach=np.ones((2, 50), np.float32),
    )
    return points, muscles


def test_muscles_in_parallel_stay_short_of_their_origins_where_a_sum_goes_past_them():
    points, muscles = two_muscles()
    heights = {}
    for method in METHODS:
        out = np.empty_like(points)
        Combiner(points, muscles, method).apply(np.ones(2), out)
        heights[method] = out[:, 1].max()
    assert heights["summed"] > 0.05 + 0.005
    assert heights["parallel"] < 0.05


def test_a_vertex_at_an_origin_stays_finite_in_the_kernel():
    points, muscles = two_muscles()
    points[0] = muscles.origin[0]
    out = np.empty_like(points)
    Combiner(points, muscles).apply(np.array([1.0, 0.0]), out)
    assert np.isfinite(out).all()
    assert out[0].tolist() == points[0].tolist()


@pytest.mark.parametrize("bad", [np.nan, -0.1, 1.1, np.inf])
def test_a_contraction_out_of_range_is_refused_by_name_and_changes_nothing(bad):
    contractions = np.zeros(COUNT)
    contractions[3] = bad
    out = np.full_like(rig().vertices, 5.0)
    with pytest.raises(InvalidValueError, match="contraction of zygomaticus_minor_r"):
        combiner("parallel").apply(contractions, out)
    assert (out == 5.0).all()


def test_arrays_that_do_not_fit_are_refused():
    face = rig()
    with pytest.raises(InvalidValueError, match="contractions"):
        combiner("parallel").apply(np.zeros(3), np.empty_like(face.vertices))
    for out in (np.empty((5, 3), np.float32), face.vertices.astype(np.float64), np.empty_like(face.vertices).T):
        with pytest.raises(InvalidValueError, match="out: expected float32"):
            combiner("parallel").apply(np.zeros(COUNT), out)
    with pytest.raises(InvalidValueError, match="rest_vertices"):
        Combiner(face.vertices[:-1], face.muscles)
    with pytest.raises(UnknownNameError, match="parallel"):
        Combiner(face.vertices, face.muscles, "paralel")
