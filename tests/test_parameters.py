import copy
import math
import pickle

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface import parameters
from agentface.errors import InvalidValueError, UnknownNameError
from agentface.parameters import COUNT, MUSCLES, PARAMETERS, FacePose, indices_of


def test_every_parameter_stands_where_its_index_says():
    assert [parameter.index for parameter in PARAMETERS] == list(range(COUNT))
    assert len({parameter.name for parameter in PARAMETERS}) == COUNT


def test_there_are_at_least_twenty_four_vector_muscles_in_pairs():
    names = parameters.VECTOR_MUSCLES
    assert len(names) >= 24
    assert {name[:-2] for name in names if name.endswith("_l")} == {name[:-2] for name in names if name.endswith("_r")}


@pytest.mark.parametrize("muscle", MUSCLES)
def test_a_muscle_without_side_is_one_or_two_parameters(muscle):
    found = [PARAMETERS[index].name for index in indices_of(muscle)]
    assert found in ([muscle], [f"{muscle}_l", f"{muscle}_r"])


def test_unknown_names_get_the_nearest_as_hint():
    with pytest.raises(UnknownNameError, match="did you mean zygomaticus_major"):
        FacePose.of(zygomaticus_mayor=0.5)


@pytest.mark.parametrize("value", [-0.01, 1.01, float("nan"), float("inf"), "0.5", True, None])
def test_refuses_contractions_that_are_none(value):
    with pytest.raises(InvalidValueError):
        FacePose.of(risorius=value)


@given(st.dictionaries(st.sampled_from(MUSCLES), st.floats(0, 1)))
def test_a_pose_holds_what_it_was_given_and_nothing_else(contractions):
    pose = FacePose.of(**contractions)
    for parameter in PARAMETERS:
        base = (
            parameter.name if parameter.name in contractions else parameter.name.removesuffix("_l").removesuffix("_r")
        )
        assert pose[parameter.name] == pytest.approx(contractions.get(base, 0.0), abs=1e-6)


def test_a_pose_does_not_change():
    pose = FacePose.of(jaw_open=0.5)
    with pytest.raises(ValueError, match="read-only"):
        pose.array[0] = 1.0
    with pytest.raises(InvalidValueError):
        FacePose(np.full(COUNT, np.nan, np.float32))
    with pytest.raises(InvalidValueError):
        FacePose(np.zeros(3, np.float32))


def test_the_table_is_consistent():
    for known in PARAMETERS:
        assert known.low <= known.neutral <= known.high
        assert known.low == np.float32(known.low)
        assert known.high == np.float32(known.high)
        assert known.way in parameters.WAYS
        assert known.group in parameters.GROUPS
        assert known.contracts == (known.name in parameters.CONTRACTIONS)
        if known.contracts:
            assert (known.low, known.high, known.bounds) == (0.0, 1.0, (0.0, 1.0))
        else:
            assert known.held == (known.unit == "share")
        if known.unit == "share":
            assert known.bounds in ((-1.0, 1.0), (0.0, 1.0)), "of what has no opposite, one side alone"
        if known.unit == "rad":
            assert [math.radians(bound) for bound in known.bounds] == pytest.approx([known.low, known.high], abs=1e-6)


def test_partners_are_each_others_on_the_other_side():
    by_name = {known.name: known for known in PARAMETERS}
    for known in PARAMETERS:
        side = known.name[-2:]
        assert (known.partner is None) == (side not in ("_l", "_r"))
        if known.partner is not None:
            other = by_name[known.partner]
            assert other.partner == known.name
            assert {side, other.name[-2:]} == {"_l", "_r"}
            assert (other.kind, other.unit, other.group, other.way) == (known.kind, known.unit, known.group, known.way)


@given(st.lists(st.floats(0, 1), min_size=COUNT, max_size=COUNT))
def test_the_image_of_an_image_is_the_pose(fractions):
    pose = FacePose((parameters.LOW + (parameters.HIGH - parameters.LOW) * np.array(fractions)).astype(np.float32))
    image = pose.mirrored()
    assert image.mirrored() == pose
    assert image["jaw_shift"] == -pose["jaw_shift"]
    assert image["jaw_thrust"] == pose["jaw_thrust"]
    assert image["cheek_puff_l"] == pose["cheek_puff_r"]


def test_a_signed_or_turned_parameter_is_no_muscle():
    for name in ("gaze_yaw", "gaze_pitch", "gaze_vergence", "head_yaw", "head_pitch", "head_roll"):
        assert name not in parameters.muscle_names()
        assert not parameters.parameter(name).contracts
    shares = [known.name for known in PARAMETERS if known.unit == "share"]
    assert {"jaw_thrust", "mouth_shift", "orbicularis_oris_roll_upper_l", "cheek_puff_r"} <= set(shares)
    assert not set(shares) & set(parameters.muscle_names())
    bounds = {known.name: known.bounds for known in PARAMETERS if known.unit == "rad"}
    assert bounds == {
        "gaze_yaw": (-50, 50), "gaze_pitch": (-40, 40), "gaze_vergence": (-10, 25),
        "head_yaw": (-80, 80), "head_pitch": (-60, 60), "head_roll": (-50, 50),
    }  # fmt: skip
    assert "jaw_open" in parameters.muscle_names()


def test_a_pose_is_a_whole_mapping():
    pose = FacePose.of(risorius=0.25, head_yaw=-0.5)
    assert list(pose.values()) == pose.array.tolist()
    assert dict(pose) == dict(zip(parameters.NAMES, pose.array.tolist(), strict=True))
    assert pose == dict(pose)
    assert "risorius_l" in pose


@given(st.dictionaries(st.sampled_from(MUSCLES), st.floats(0, 1)))
def test_equal_poses_hash_pickle_and_copy_alike(contractions):
    pose, same = FacePose.of(**contractions), FacePose.of(**contractions)
    assert pose == same
    assert hash(pose) == hash(same)
    for twin in (pickle.loads(pickle.dumps(pose)), copy.copy(pose), copy.deepcopy(pose)):  # noqa: S301 - our own bytes
        assert type(twin) is FacePose
        assert twin == pose
        assert not twin.array.flags.writeable
    assert pose.replace({"jaw_open": 0.5}) != pose.replace({"jaw_open": 0.25})


def test_a_negative_zero_is_a_zero():
    minus = FacePose(np.full(COUNT, -0.0, np.float32))
    assert minus == FacePose()
    assert hash(minus) == hash(FacePose())
    assert pickle.dumps(minus) == pickle.dumps(FacePose())
