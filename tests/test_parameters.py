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
        pose.values[0] = 1.0
    with pytest.raises(InvalidValueError):
        FacePose(np.full(COUNT, np.nan, np.float32))
    with pytest.raises(InvalidValueError):
        FacePose(np.zeros(3, np.float32))
