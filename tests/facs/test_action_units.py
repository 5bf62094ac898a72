from __future__ import annotations

import math

import pytest

from agentface.errors import DataError, InvalidValueError, UnknownNameError
from agentface.facs.action_units import (
    LETTERS,
    action_units,
    check_intensity,
    check_side,
    check_unit,
    load_action_units,
)
from agentface.parameters import FacePose

OPENFACE = (1, 2, 4, 5, 6, 7, 9, 10, 12, 14, 15, 17, 20, 23, 25, 26, 45)


def test_every_unit_that_openface_finds_has_a_row():
    assert set(OPENFACE) <= action_units().keys()


def test_a_whole_unit_is_a_pose():
    assert action_units()[14].pose == FacePose.of(buccinator=1.0)
    assert action_units()[35].pose == FacePose().replace({"cheek_puff_l": -1.0, "cheek_puff_r": -1.0})
    assert action_units()[51].pose["head_yaw"] == pytest.approx(math.radians(40))


def test_only_what_the_artists_made_of_vector_muscles_is_fitted():
    fitted = [number for number, unit in action_units().items() if unit.fitted]
    assert fitted == [1, 2, 4, 6, 9, 10, 12, 15, 16, 17, 20]


@pytest.mark.parametrize("said", [12, "12", "AU12", "au 12"])
def test_a_unit_is_meant_by_its_number(said):
    assert check_unit(said) == 12


@pytest.mark.parametrize("said", [0, 3, 999, -12, 12.0, "twelve", None, True, "1 2", math.nan])
def test_what_is_no_unit_is_refused(said):
    with pytest.raises(UnknownNameError, match="action unit"):
        check_unit(said)


def test_letters_rise_to_the_whole():
    values = [check_intensity(letter) for letter in "abcde"]
    assert values == sorted(LETTERS.values())
    assert values[-1] == 1.0
    assert check_intensity(0.3) == 0.3
    for wrong in ("F", "", "AB", 1.5, math.nan, None):
        with pytest.raises(InvalidValueError):
            check_intensity(wrong)


def test_sides_are_the_persons():
    assert [check_side(side) for side in ("left", "RIGHT", "l", "r", "both", None)] == ["l", "r", "l", "r", None, None]
    for wrong in ("middle", "", 1):
        with pytest.raises(UnknownNameError):
            check_side(wrong)


def test_all_faults_of_a_table_come_at_once(tmp_path):
    path = tmp_path / "action_units.yaml"
    path.write_text(
        "action_units:\n"
        "  1: {name: one, muscles: {frontalis_medialiss: 1.0}}\n"
        "  2: {name: nothing}\n"
        "  3: {name: far, moves: {head_yaw_deg: 300.0, cheek_puf: 1.0, jaw_thrust: -2.0}}\n"
    )
    with pytest.raises(DataError) as caught:
        load_action_units(path)
    found = {(fault.line, fault.where) for fault in caught.value.faults}
    assert found == {
        (2, "action_units.1.muscles.frontalis_medialiss"),
        (3, "action_units.2"),
        (4, "action_units.3.moves.head_yaw_deg"),
        (4, "action_units.3.moves.cheek_puf"),
        (4, "action_units.3.moves.jaw_thrust"),
    }
