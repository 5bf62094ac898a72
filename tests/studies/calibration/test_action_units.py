from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.errors import DataError
from agentface.facs.action_units import ActionUnit, load_action_units
from agentface.parameters import VECTOR_MUSCLES
from agentface.resources import rules_file
from agentface.studies.calibration.fit import groups

NAMES = [name[:-2] for name in VECTOR_MUSCLES[:16:2]]
UNITS = st.lists(st.dictionaries(st.sampled_from(NAMES), st.just(1.0), min_size=1, max_size=3), max_size=10).map(
    lambda sets: [ActionUnit(i, "", muscles, {"shape": 1.0}, 1.0) for i, muscles in enumerate(sets)]
)


@given(units=UNITS)
def test_no_muscle_is_in_two_groups_and_no_unit_is_lost(units):
    found = groups(units)
    assert sorted(unit.number for group in found for unit in group.units) == [unit.number for unit in units]
    for i, group in enumerate(found):
        assert len(set(group.muscles)) == len(group.muscles)
        assert set(group.muscles) == {name for unit in group.units for name in unit.muscles}
        for other in found[:i]:
            assert not set(group.muscles) & set(other.muscles)


def test_units_of_lids_lips_and_jaw_are_not_fitted():
    units = load_action_units()
    measured = {number for number, unit in units.items() if unit.shapes and not unit.fitted}
    assert measured == {5, 7, 14, 18, 22, 23, 24, 25, 26, 27, 28, 29, 30, 34, 43, 45}
    assert {unit.number for group in groups(list(units.values())) for unit in group.units} == {
        number for number, unit in units.items() if unit.fitted
    }


@given(units=UNITS)
def test_a_group_has_no_parts_that_share_nothing(units):
    for group in groups(units):
        linked = {group.muscles[0]}
        for _ in group.muscles:
            linked |= {name for unit in group.units if linked & unit.muscles.keys() for name in unit.muscles}
        assert linked == set(group.muscles)


def test_all_faults_of_the_table_are_found_at_once(tmp_path):
    path = tmp_path / "action_units.yaml"
    text = rules_file("action_units.yaml").read_text(encoding="utf-8")
    text = text.replace("frontalis_medialis: 1.0", "frontalis_medalis: 1.0").replace("mentalis: 1.0", "head_yaw: 1.0")
    path.write_text(text, encoding="utf-8")
    with pytest.raises(DataError) as error:
        load_action_units(path)
    first, second = error.value.faults
    assert text.splitlines()[first.line - 1].strip() == "muscles: {frontalis_medalis: 1.0}"
    assert "did you mean frontalis_medialis" in first.hint
    assert second.where == "action_units.17.muscles.head_yaw"


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ("strength: 1.15", "strength: 3", "strength"),
        ("mentalis: 1.0", "mentalis: 1.5", "mentalis"),
        ("mentalis: 1.0", "mentalis: 0", "mentalis"),
        ("{mentalis: 1.0}", "{}", "muscles"),
        ("{mouthShrugLower: 1.0}", "{mouthShrugLower: 2.0}", "shapes"),
        ("name: chin raiser", "title: chin raiser", "title"),
        ("  17:", "  seventeen:", "seventeen"),
    ],
)
def test_each_kind_of_fault_is_found_on_its_line(tmp_path, old, new, where):
    path = tmp_path / "action_units.yaml"
    text = rules_file("action_units.yaml").read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    with pytest.raises(DataError, match=where) as error:
        load_action_units(path)
    assert all(fault.line is not None for fault in error.value.faults)
