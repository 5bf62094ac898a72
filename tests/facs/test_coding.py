from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from agentface.errors import UnknownNameError
from agentface.facs.action_units import action_units
from agentface.facs.coding import intensities_of, parts_of, poses_of
from agentface.io.performances.unit_stream import ActionUnitStream
from agentface.motion.performance import HOLD_S, LET_GO_S
from agentface.parameters import COUNT, NAMES, parameter

UNITS = tuple(number for number, unit in action_units().items() if not unit.moves)


@st.composite
def codings(draw):
    units = tuple(draw(st.lists(st.sampled_from(UNITS), min_size=1, max_size=8, unique=True)))
    numbers = st.floats(0, 1, width=32)
    return units, draw(arrays.arrays(np.float32, (draw(st.integers(1, 4)), len(units)), elements=numbers))


def plainly(units, intensities):
    """The same, muscle by muscle."""
    poses = np.zeros((len(intensities), COUNT))
    for frame, row in enumerate(intensities):
        for number, intensity in zip(units, row, strict=True):
            for muscle, part in action_units()[number].muscles.items():
                for name in (muscle, f"{muscle}_l", f"{muscle}_r"):
                    if name in NAMES:
                        index = NAMES.index(name)
                        poses[frame, index] = max(poses[frame, index], part * float(intensity))
    return poses


@given(codings())
def test_a_muscle_contracts_as_far_as_the_unit_that_asks_most_of_it(coding):
    np.testing.assert_allclose(poses_of(*coding), plainly(*coding), atol=1e-6)


@given(codings())
def test_contractions_come_back_exactly_and_no_unit_weaker_than_it_was(coding):
    units, intensities = coding
    poses = poses_of(units, intensities)
    found = intensities_of(units, poses)
    np.testing.assert_allclose(poses_of(units, found), poses, atol=1e-6)
    assert (found >= intensities - 1e-6).all()


def test_signed_movements_add_up_and_come_back():
    assert action_units()[28].moves
    poses = poses_of((12, 28), np.array([[0.5, 0.25]], np.float32))
    for name, part in action_units()[28].moves.items():
        assert poses[0, parameter(f"{name}_l").index] == pytest.approx(0.25 * part)
    np.testing.assert_allclose(intensities_of((12, 28), poses), [[0.5, 0.25]])
    left_and_right = poses_of((51, 52), np.ones((1, 2)))
    assert left_and_right[0, parameter("head_yaw").index] == pytest.approx(0.0, abs=1e-6)


def test_lips_part_with_a_dropped_jaw_and_no_further():
    both, jaw = poses_of((25, 26), np.ones((1, 2))), poses_of((26,), np.ones((1, 1)))
    np.testing.assert_array_equal(both, jaw)


def test_half_the_intensity_is_half_the_contraction():
    for number in UNITS:
        np.testing.assert_array_equal(poses_of((number,), [[0.5]]), 0.5 * poses_of((number,), [[1.0]]))


def test_a_unit_that_the_table_lacks_is_told():
    with pytest.raises(UnknownNameError, match="99"):
        parts_of((12, 99))


def test_a_stream_moves_the_muscles_of_its_units_and_what_was_seen():
    stream = ActionUnitStream(
        np.array([0.0, 0.5]),
        (12,),
        np.array([[0.0], [1.0]], np.float32),
        gaze=np.array([[0.1, 9.0], [0.1, 0.2]], np.float32),
    )
    played = stream.performance()
    assert set(played.moved) == {"zygomaticus_major_l", "zygomaticus_major_r", "gaze_yaw", "gaze_pitch"}
    assert played.poses[:, parameter("zygomaticus_major_l").index].tolist() == [0, 1]
    assert played.poses[0, parameter("gaze_pitch").index] == np.float32(parameter("gaze_pitch").high)


def test_in_a_long_gap_the_face_lets_go_and_in_a_short_one_not():
    times = np.array([0.0, 1.0, 2.0, 7.0])
    stream = ActionUnitStream(times, (12,), np.full((4, 1), 0.5, np.float32))
    played = stream.performance()
    assert np.isin(times, played.times_s).all()
    at = [0.5, 1.5, 2.0 + HOLD_S, 2.0 + HOLD_S + LET_GO_S, 4.5, 7.0 - LET_GO_S, 7.0]
    smile = parameter("zygomaticus_major_l").index
    values, weights = (rows[:, smile] for rows in played.sample(at))
    assert weights.tolist() == [1, 1, 1, 0, 0, 0, 1]
    assert values == pytest.approx([0.5] * 7)


@given(codings())
def test_a_stream_comes_back_from_its_performance(coding):
    units, intensities = coding
    stream = ActionUnitStream(np.arange(len(intensities)) / 30, units, intensities)
    again = ActionUnitStream.of(stream.performance(), units)
    np.testing.assert_allclose(poses_of(units, again.intensities), poses_of(units, intensities), atol=1e-6)
