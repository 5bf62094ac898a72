import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from agentface.deform.muscles.vector_muscle import angular, displacement, pull, radial
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.head.muscle_set import FALLOFFS, MuscleSet

ORIGIN, INSERTION = np.array([0.0, 0.05, 0.0]), np.array([0.0, 0.0, 0.01])
SHAPE = {"zone": 0.7, "fall_start": 0.03, "fall_finish": 0.06, "elasticity": 0.012}
NEAR = arrays(np.float64, (20, 3), elements=st.floats(-0.1, 0.1))
FALLOFF = st.sampled_from(FALLOFFS)


def move(points, contraction=1.0, falloff="smooth", **changes):
    return displacement(points, ORIGIN, INSERTION, contraction=contraction, falloff=falloff, **{**SHAPE, **changes})


def on_axis(distance, angle=0.0):
    """Points at a distance from the origin, turned from the axis about X."""
    axis = (INSERTION - ORIGIN) / np.linalg.norm(INSERTION - ORIGIN)
    aside = np.cross(axis, [1.0, 0.0, 0.0])
    return ORIGIN + np.atleast_1d(distance)[:, None] * (math.cos(angle) * axis + math.sin(angle) * aside)


@given(points=NEAR, falloff=FALLOFF)
def test_no_contraction_moves_nothing(points, falloff):
    assert not move(points, 0.0, falloff).any()


@given(points=NEAR, falloff=FALLOFF, contraction=st.floats(0.0, 1.0))
def test_displacement_is_bounded_and_points_to_the_origin(points, falloff, contraction):
    moved = move(points, contraction, falloff)
    assert np.linalg.norm(moved, axis=1).max() <= contraction * SHAPE["elasticity"] * (1 + 1e-12)
    spoke = ORIGIN - points
    assert (np.einsum("ij,ij->i", moved, spoke) >= 0.0).all()
    assert np.abs(np.cross(moved, spoke)).max() < 1e-15


@given(points=NEAR, falloff=FALLOFF)
def test_matches_the_printed_formula_point_by_point(points, falloff):
    for point, moved in zip(points, move(points, 0.5, falloff), strict=True):
        spoke = [p - o for p, o in zip(point, ORIGIN, strict=True)]
        axis = [i - o for i, o in zip(INSERTION, ORIGIN, strict=True)]
        distance = math.sqrt(sum(s * s for s in spoke))
        if distance == 0.0:
            assert not moved.any()
            continue
        cosine = sum(s * a for s, a in zip(spoke, axis, strict=True)) / distance / math.hypot(*axis)
        alpha = math.acos(max(-1.0, min(1.0, cosine)))
        if abs(alpha - SHAPE["zone"]) < 1e-9:
            continue
        size = 0.0
        if alpha <= SHAPE["zone"] and distance <= SHAPE["fall_finish"]:
            if distance <= SHAPE["fall_start"]:
                fall = math.sin(distance / SHAPE["fall_start"] * math.pi / 2)
            else:
                gap = SHAPE["fall_finish"] - SHAPE["fall_start"]
                fall = math.cos((distance - SHAPE["fall_start"]) / gap * math.pi / 2)
            edge = math.cos(SHAPE["zone"])
            size = 0.5 * SHAPE["elasticity"] * fall * (cosine if falloff == "waters" else (cosine - edge) / (1 - edge))
        assert moved == pytest.approx([-size * s / distance for s in spoke], abs=1e-12)


@pytest.mark.parametrize("falloff", FALLOFFS)
def test_a_point_at_the_origin_stays(falloff):
    assert not move(ORIGIN[None], 1.0, falloff).any()


@pytest.mark.parametrize("falloff", FALLOFFS)
def test_the_largest_displacement_is_the_elasticity_on_the_axis_at_fall_start(falloff):
    moved = np.linalg.norm(move(on_axis(np.linspace(0.001, 0.08, 400)), 1.0, falloff), axis=1)
    peak = np.linalg.norm(move(on_axis(SHAPE["fall_start"]), 1.0, falloff))
    assert peak == pytest.approx(SHAPE["elasticity"], rel=1e-12)
    assert moved.max() <= peak * (1 + 1e-12)


def test_the_fall_off_is_continuous_along_the_axis_and_zero_at_both_ends():
    distance = np.linspace(0.0, 0.08, 8001)
    fall = radial(distance, SHAPE["fall_start"], SHAPE["fall_finish"])
    assert fall[0] == pytest.approx(0.0, abs=1e-12)
    assert not fall[distance > SHAPE["fall_finish"]].any()
    assert np.abs(np.diff(fall)).max() < 1e-3


def test_waters_has_a_cliff_at_the_edge_of_the_zone_and_smooth_has_none():
    edge = SHAPE["zone"]
    for falloff, height in (("waters", math.cos(edge)), ("smooth", 0.0)):
        inside, outside = angular(np.cos([edge - 1e-7, edge + 1e-7]), edge, falloff)
        assert inside == pytest.approx(height, abs=1e-5)
        assert outside == 0.0


@given(angle=st.floats(0.7001, math.pi), distance=st.floats(0.001, 0.1), falloff=FALLOFF)
def test_nothing_moves_outside_the_zone(angle, distance, falloff):
    assert not move(on_axis(distance, angle), 1.0, falloff).any()


@given(distance=st.floats(0.0600001, 1.0), falloff=FALLOFF)
def test_nothing_moves_beyond_fall_finish(distance, falloff):
    assert not move(on_axis(distance), 1.0, falloff).any()


def make_set(**changes):
    values = {
        "names": ["risorius_l", "risorius_r"],
        "origin": [[0.05, 0, 0], [-0.05, 0, 0]],
        "insertion": [[0.02, 0, 0], [-0.02, 0, 0]],
        "zone": [0.6, 0.6],
        "fall_start": [0.02, 0.02],
        "fall_finish": [0.05, 0.05],
        "elasticity": [0.01, 0.01],
        "reach": np.ones((2, 5), np.float32),
    }
    return MuscleSet(**{**values, **changes})


def test_a_set_finds_its_muscles_by_name():
    muscles = make_set()
    assert (len(muscles), muscles.vertex_count, muscles.index("risorius_r")) == (2, 5, 1)
    with pytest.raises(UnknownNameError, match="did you mean risorius_l"):
        muscles.index("risoris_l")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"origin": [[0.05, 0, 0]]}, r"origin: expected an array of shape \(2, 3\)"),
        ({"zone": [0.6, math.nan]}, "zone: expected finite numbers"),
        ({"zone": [0.6, 1.7]}, "risorius_r: zone: expected a half angle"),
        ({"fall_start": [0.0, 0.02]}, "risorius_l: fall_start: expected a distance above 0"),
        ({"fall_finish": [0.05, 0.02]}, "risorius_r: fall_finish: expected a distance beyond"),
        ({"elasticity": [-0.01, 0.01]}, "risorius_l: elasticity"),
        ({"insertion": [[0.05, 0, 0], [0, 0, 0]]}, "risorius_l: insertion"),
        ({"reach": np.full((2, 5), 1.5)}, "risorius_l: reach: expected weights"),
        ({"reach": np.ones(5)}, "reach: expected an array of shape"),
    ],
)
def test_a_set_refuses_what_cannot_be(change, message):
    with pytest.raises(InvalidValueError, match=message):
        make_set(**change)


def test_a_set_refuses_an_unknown_fall_off():
    with pytest.raises(UnknownNameError, match="smooth"):
        make_set(falloff="smoth")


def test_reach_scales_the_displacement():
    muscles = make_set(reach=np.linspace(0, 1, 5, dtype=np.float32) * np.ones((2, 1), np.float32))
    points = np.tile([0.03, 0.001, 0.0], (5, 1))
    moved = pull(muscles, 0, points, 1.0)
    whole = pull(dataclasses.replace(muscles, reach=np.ones((2, 5), np.float32)), 0, points, 1.0)
    assert whole.all(axis=0)[0]
    np.testing.assert_allclose(moved, whole * np.linspace(0, 1, 5)[:, None], atol=1e-15)
