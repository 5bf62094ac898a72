from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface import Face
from agentface.conventions import SIDES
from agentface.facs.action_units import action_units
from agentface.motion.action_units import ActionUnitChannel
from agentface.parameters import HIGH, LOW, NAMES, PARAMETERS, FacePose, indices_of
from tests.heads import head_model

LEVELS = st.dictionaries(
    st.tuples(st.sampled_from(sorted(action_units())), st.sampled_from((*SIDES, None))), st.floats(0, 1), max_size=6
)


def shown(levels):
    channel = ActionUnitChannel()
    for (number, side), level in levels.items():
        channel.set(number, level, side, 0.0)
    values = np.zeros(len(channel.names))
    if not channel.write(values, np.ones(len(values))):
        values[:] = 0.0
    return dict(zip(channel.names, values.tolist(), strict=True))


@pytest.mark.parametrize("number", sorted(action_units()))
def test_a_unit_alone_is_its_pose(number):
    found = shown({(number, None): 1.0})
    assert found == pytest.approx({name: action_units()[number].pose[name] for name in found}, abs=1e-6)


def test_one_side_leaves_the_other():
    found = shown({(12, "l"): 0.8})
    assert (found["zygomaticus_major_l"], found["zygomaticus_major_r"]) == (0.8, 0.0)
    assert shown({(30, "r"): 0.5})["jaw_shift"] == -0.5
    assert shown({(30, "l"): 0.5, (30, "r"): 0.5})["jaw_shift"] == 0.0
    assert shown({(26, "r"): 0.6})["jaw_open"] == pytest.approx(0.3)
    assert shown({(29, "r"): 0.6})["jaw_thrust"] == pytest.approx(0.6)


def test_units_that_share_a_muscle_do_not_add_up():
    """Lips part and jaw drop both open the jaw: 0.2 and 0.5 of it."""
    assert shown({(25, None): 1.0, (26, None): 1.0})["jaw_open"] == pytest.approx(0.5)
    assert shown({(4, None): 0.6, (9, None): 1.0})["corrugator_supercilii_l"] == pytest.approx(0.6)


def test_opposite_movements_cancel():
    assert shown({(34, None): 1.0, (35, None): 1.0})["cheek_puff_l"] == 0.0
    assert shown({(51, None): 0.5, (52, None): 0.25})["head_yaw"] == pytest.approx(math.radians(10))


@given(LEVELS)
def test_any_units_are_one_oracle(levels):
    """By loops over the sides that are asked for, the last word on each counting."""
    asked = {}
    for (number, side), level in levels.items():
        unit = action_units()[number]
        aside = (side or SIDES[0],) if number == 30 else SIDES
        sides = (side,) if side and unit.has_sides else aside
        asked |= {(number, one): level for one in sides}
    contracted, added = {}, {}
    for number in {number for number, _ in asked}:
        moved = {}
        for side in SIDES:
            level = asked.get((number, side), 0.0)
            for name, part in action_units()[number].parts.items():
                indices = indices_of(name)
                known = PARAMETERS[indices[-1 if side == "r" and len(indices) > 1 else 0]]
                sign = -1.0 if side == "r" and known.sideways and known.unit == "share" else 1.0
                moved.setdefault(known, []).append(sign * part * level)
        for known, values in moved.items():
            if known.contracts:
                contracted[known.name] = max(contracted.get(known.name, 0.0), *values)
            else:
                added[known.name] = added.get(known.name, 0.0) + max(*values, 0.0) + min(*values, 0.0)
    expected = contracted | added
    for name, value in shown(levels).items():
        assert value == pytest.approx(expected.get(name, 0.0), abs=1e-9)


@pytest.mark.untraced
@given(LEVELS)
def test_the_face_stays_in_its_ranges_and_mirrors(levels):
    face, image = (Face(head_model(), compiled=False) for _ in range(2))
    swapped = {"l": "r", "r": "l", None: None}
    turned = {51: 52, 52: 51, 55: 56, 56: 55, 61: 62, 62: 61}
    for (number, side), level in levels.items():
        if number == 30 and side is None:
            continue  # means the left
        face.set_action_unit(number, level, side=side, fade=0)
        image.set_action_unit(turned.get(number, number), level, side=swapped[side], fade=0)
    pose = face.channels.pose()
    assert ((pose.array >= LOW) & (pose.array <= HIGH)).all()
    np.testing.assert_allclose(image.channels.pose().array, pose.mirrored().array, atol=1e-6)


def test_a_face_smiles_with_one_side_beside_its_emotion():
    face = Face(head_model(), compiled=False)
    face.set_emotion("sadness", 0.5, fade=0)
    sad = face.channels.pose()
    face.set_action_unit(12, "D", side="left", fade=0)
    pose = face.channels.pose()
    assert pose["zygomaticus_major_l"] == pytest.approx(0.8)
    moved = {name for name in NAMES if pose[name] != sad[name]}
    assert moved == {"zygomaticus_major_l"}
    assert face.status()["action_units"] == {"12l": 0.8}
    assert face.status()["drivers"]["action_units"] == ["zygomaticus_major_l"]
    face.neutral(fade=0)
    assert face.channels.pose() == FacePose()
    assert face.status()["action_units"] == face.status()["drivers"] == {}


def test_what_is_held_by_hand_hides_the_other_drivers():
    face = Face(head_model(), compiled=False)
    face.set_emotion("happiness", 1.0, fade=0)
    face.set_muscle("zygomaticus_major_l", 0.2, fade=0)
    drivers = face.channels.drivers()
    assert drivers["muscles"] == ["zygomaticus_major_l"]
    assert "zygomaticus_major_l" not in drivers["emotion"]
    assert "zygomaticus_major_r" in drivers["emotion"]
