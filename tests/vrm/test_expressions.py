"""``rules/vrm.yaml``: what it must have, and that every fault of it is told."""

from __future__ import annotations

import pytest

from agentface.emotion.state import EMOTIONS
from agentface.errors import DataError
from agentface.resources import rules_file
from agentface.vrm.expressions import PRESETS, VRM_FILE, expression_table, load_expressions

# The table of the protocol's specification (3.1) and of VRM's migration from 0 to 1
VRM0 = {
    "Joy": "happy", "Angry": "angry", "Sorrow": "sad", "Fun": "relaxed", "A": "aa", "I": "ih", "U": "ou", "E": "ee",
    "O": "oh", "Blink": "blink", "Blink_L": "blinkLeft", "Blink_R": "blinkRight", "LookUp": "lookUp",
    "LookDown": "lookDown", "LookLeft": "lookLeft", "LookRight": "lookRight", "Neutral": "neutral",
}  # fmt: skip


def test_names_are_the_specification_s():
    table = expression_table()
    assert tuple(table) == PRESETS
    assert len(PRESETS) == 18
    assert {row.vrm0: name for name, row in table.items() if name != "surprised"} == VRM0


def test_each_of_the_six_is_shown_somehow():
    felt = expression_table().felt
    assert set(felt) == set(EMOTIONS)
    assert all(shares for shares in felt.values())


@pytest.mark.parametrize(
    ("good", "wrong", "fault"),
    [
        ("  happy: {vrm0: Joy, emotions", "  hapy: {vrm0: Joy, emotions", "expressions.happy: expected this key"),
        ("{vrm0: A, viseme: aa}", "{vrm0: A, viseme: ah}", "expressions.aa.viseme: expected a viseme"),
        ("{vrm0: I, viseme: ih}", "{vrm0: A, viseme: ih}", "expressions.ih.vrm0: expected each name once"),
        ("{vrm0: O, viseme: oh}", "{vrm0: O, viseme: oh, closes: [left]}", "expressions.oh: expected one of"),
        ("closes: [left]}", "closes: [up]}", "expressions.blinkLeft.closes.0"),
        ("looks: [0, 1]}", "looks: [0, 2]}", "expressions.lookUp.looks.1"),
        ("{surprised: 0.6", "{suprised: 0.6", "did you mean surprised"),
        ("  sadness: {sad: 1}\n", "", "felt.sadness: expected this key"),
        ("neck: 0.4", "neck: 1.4", "neck: expected less than or equal to 1"),
        ("happiness: 1}}", "glee: 1}}", "expressions.happy.emotions.glee"),
    ],
)
def test_faults_are_told_with_their_place(tmp_path, good, wrong, fault):
    text = rules_file(VRM_FILE).read_text()
    assert good in text
    path = tmp_path / VRM_FILE
    path.write_text(text.replace(good, wrong, 1))
    with pytest.raises(DataError) as raised:
        load_expressions(path)
    assert fault in str(raised.value)
    assert all(found.line is not None for found in raised.value.faults)
