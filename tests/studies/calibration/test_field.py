from __future__ import annotations

from functools import cache

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.deform.muscles.combine import parallel
from agentface.head.muscle_set import MuscleSet
from agentface.studies.calibration.field import displacements
from tests.deform.rig import make_rig


@cache
def rest():
    return make_rig(24, 36).vertices.astype(np.float64)


def random_muscles(draw, count):
    points = rest()
    origin = points[draw.integers(len(points), size=count)] + draw.normal(0, 0.005, (count, 3))
    start = draw.uniform(0.01, 0.08, count)
    return MuscleSet(
        names=[f"m{i}" for i in range(count)],
        origin=origin,
        insertion=origin + draw.normal(0, 0.03, (count, 3)),
        zone=draw.uniform(0.1, 1.5, count),
        fall_start=start,
        fall_finish=start + draw.uniform(0.005, 0.06, count),
        elasticity=draw.uniform(0.0, 0.03, count),
        reach=draw.random((count, len(points))) * (draw.random((count, len(points))) < 0.8),
    )


@settings(max_examples=40)
@given(seed=st.integers(0, 2**32 - 1), count=st.integers(1, 6))
def test_the_fits_field_is_the_deformers(seed, count):
    draw = np.random.default_rng(seed)
    muscles = random_muscles(draw, count)
    contraction = np.where(draw.random(count) < 0.3, 1.0, draw.random(count))
    rows = np.column_stack(
        [
            muscles.origin,
            muscles.insertion,
            np.cos(muscles.zone),
            muscles.fall_start,
            muscles.fall_finish,
            muscles.elasticity,
        ]
    )
    moved = displacements(rest(), rows, muscles.reach.astype(np.float64), contraction)
    expected = parallel(rest(), muscles, contraction) - rest()
    assert np.abs(moved - expected).max() < 1e-7


def test_no_contraction_moves_nothing():
    muscles = random_muscles(np.random.default_rng(1), 3)
    rows = np.column_stack([muscles.origin, muscles.insertion, np.ones((3, 4)) * [0.5, 0.02, 0.05, 0.01]])
    assert not displacements(rest(), rows, muscles.reach.astype(np.float64), np.zeros(3)).any()
