"""The table of FAPs: what the standard says of it as a whole, and what is told of a broken one."""

from __future__ import annotations

import pytest

from agentface.commands.check import faults_of
from agentface.errors import DataError, InvalidValueError, UnknownNameError
from agentface.head.feature_points import FEATURE_POINTS
from agentface.mpeg4.fap_table import load_faps
from agentface.mpeg4.faps import FAP_NAMES, FAPS, LOW_LEVEL, fap
from agentface.resources import rules_file


def test_the_groups_have_the_standard_s_sizes():
    sizes = [sum(each.group == group for each in FAPS) for group in range(1, 11)]
    assert sizes == [2, 16, 12, 8, 4, 5, 3, 10, 4, 4]


def test_every_low_level_fap_moves_points_of_its_group():
    for each in LOW_LEVEL:
        assert set(each.points) <= set(FEATURE_POINTS)
        assert {point.split(".")[0] for point in each.points} == {str(each.group)}


def test_mirror_images_differ_in_direction_alone():
    mirrored = {"left": "right", "right": "left"}
    pairs = 0
    for each in LOW_LEVEL:
        other = each.name.replace("_l_", "_?_").replace("_r_", "_l_").replace("_?_", "_r_")
        other = other.replace("_lip_lm", "_lip_?m").replace("_lip_rm", "_lip_lm").replace("_lip_?m", "_lip_rm")
        if other == each.name:
            continue
        image = fap(other)
        pairs += 1
        sideways = mirrored.get(each.positive) if each.number not in (23, 24) else each.positive
        assert image.positive == (sideways or each.positive)
        assert (image.low, image.high, image.unit) == (each.low, each.high, each.unit)
    assert pairs == 46


def test_the_largest_turns_are_half_a_turn():
    for number in (48, 49, 50):
        assert fap(number).high * 1e-5 == pytest.approx(3.162)
    assert fap("open_jaw").low == 0
    assert (fap("open_jaw").high, fap("raise_b_midlip").low) == (4320, -3720)


def test_a_fap_is_known_by_number_and_name():
    assert fap(19) is fap("close_t_l_eyelid") is FAPS[18]
    assert len(set(FAP_NAMES)) == 68
    for wrong in (0, 69, True, 1.5):
        with pytest.raises(InvalidValueError, match=r"1\.\.68"):
            fap(wrong)
    with pytest.raises(UnknownNameError, match="open_jaw"):
        fap("open_jav")


def test_every_fault_of_a_table_is_told(tmp_path):
    text = rules_file("faps.yaml").read_text()
    for old, new in (
        ("  4: {name: lower_t_midlip", "  4: {name: open_jaw"),
        ("intra: [-1860, 1860]", "intra: [1860, -1860]"),
        ("  68:", "  69:"),
        ("unit: MW, positive: left", "unit: MX, positive: left"),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    path = tmp_path / "faps.yaml"
    path.write_text(text)
    with pytest.raises(DataError) as caught:
        load_faps(path)
    assert {fault.where for fault in caught.value.faults} == {"faps.69", "faps.6.unit"}
    assert all(fault.line for fault in caught.value.faults)
    path.write_text(text.replace("unit: MX", "unit: MW").replace("  69:", "  67:", 1))
    assert {fault.where for fault in faults_of(path)} == {"faps.67"}, "a number twice"
    kept = "\n".join(line for line in text.replace("unit: MX", "unit: MW").splitlines() if "  69:" not in line)
    path.write_text(kept)
    assert {fault.where for fault in faults_of(path)} == {"faps", "faps.4.name", "faps.5.intra"}


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ("1: {name: viseme,", "1: {name: viseme, unit: MW,", "faps.1.unit"),
        ("positive: down, bidirectional: false, quantiser: 4", "bidirectional: false, quantiser: 4", "faps.3.positive"),
        ("bidirectional: false, quantiser: 4", "bidirectional: true, quantiser: 4", "faps.3.intra.0"),
    ],
)
def test_a_row_that_contradicts_itself(tmp_path, old, new, where):
    path = tmp_path / "faps.yaml"
    text = rules_file("faps.yaml").read_text()
    assert old in text
    path.write_text(text.replace(old, new, 1))
    assert [fault.where for fault in faults_of(path)] == [where]
