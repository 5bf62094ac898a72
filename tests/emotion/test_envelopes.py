from __future__ import annotations

import numpy as np
import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.emotion.envelopes import default_envelopes, load_envelopes
from agentface.emotion.ramps import KNOTS, exponential_offset, exponential_onset
from agentface.emotion.state import EMOTIONS
from agentface.errors import DataError
from agentface.resources import rules_file

GOOD = rules_file("envelopes.yaml").read_text()
HAPPY = "  happiness:\n    onset: {s: 0.5}\n    apex: {s: 2.0}\n    offset: {s: 1.0}"


def test_surprise_is_quick_and_sadness_slow():
    envelopes = default_envelopes()
    for seconds in (envelopes.onset_s, envelopes.apex_s, envelopes.offset_s):
        assert seconds.argmin() == EMOTIONS.index("surprise")
        assert seconds.argmax() == EMOTIONS.index("sadness")
    assert (envelopes.onset_s < envelopes.offset_s).all()
    assert envelopes.mood_s > envelopes.onset_s.max()
    assert envelopes.ramps.shape == (2 * len(EMOTIONS), KNOTS, 2)
    np.testing.assert_array_equal(envelopes.ramps[:6], [exponential_onset()] * 6)
    np.testing.assert_array_equal(envelopes.ramps[6:], [exponential_offset()] * 6)


def test_a_table_of_times_and_levels_is_a_ramp(tmp_path):
    path = tmp_path / "envelopes.yaml"
    levels = "onset: {s: 1, levels: [[0.0, 0.0], [0.25, 0.75], [1.0, 1.0]]}"
    falls = "offset: {s: 2.5, levels: [[0, 1], [0.5, 0.125], [1, 0]]}"
    path.write_text(GOOD.replace(HAPPY, f"  happiness:\n    {levels}\n    apex: {{s: 0}}\n    {falls}"))
    envelopes = load_envelopes(path)
    assert (envelopes.onset_s[0], envelopes.apex_s[0], envelopes.offset_s[0]) == (1.0, 0.0, 2.5)
    assert envelopes.ramps[0, (KNOTS - 1) // 4, 0] == pytest.approx(0.75)
    assert envelopes.ramps[6, (KNOTS - 1) // 2, 0] == pytest.approx(0.875)
    assert CliRunner().invoke(cli, ["check", str(path)]).exit_code == 0


@pytest.mark.parametrize(
    ("onset", "said"),
    [
        ("{s: 0}", "greater than 0"),
        ("{s: 61.0}", "60"),
        ("{s: fast}", "number"),
        ("{levels: [[0.0, 0.0], [1.0, 1.0]]}", "this key"),
        ("{s: 0.5, levels: [[0.0, 0.1], [1.0, 1.0]]}", "from"),
        ("{s: 0.5, levels: [[0.0, 0.0], [0.5, 0.5]]}", "from"),
        ("{s: 0.5, levels: [[0.0, 0.0], [0.5, 0.5], [0.5, 0.6], [1.0, 1.0]]}", "times that rise"),
        ("{s: 0.5, levels: [[0.0, 0.0], [0.4, 0.6], [0.5, 0.5], [1.0, 1.0]]}", "only rise"),
        ("{s: 0.5, levels: [[0.0, 0.0, 0.0], [1.0, 1.0]]}", "2"),
        ("{s: 0.5, levels: [[0.0, 0.0], [0.5, 1.5], [1.0, 1.0]]}", "1"),
        ("{s: 0.5, speed: 2}", "no such key"),
    ],
)
def test_what_is_wrong_is_told_with_its_line_beside_other_faults(tmp_path, onset, said):
    path = tmp_path / "envelopes.yaml"
    text = GOOD.replace(HAPPY, HAPPY.replace("{s: 0.5}", onset)).replace("mood: {s: 1.5}", "mood: {s: -1}")
    path.write_text(text)
    with pytest.raises(DataError) as caught:
        load_envelopes(path)
    line = GOOD[: GOOD.index(HAPPY)].count("\n") + 2
    assert any(said in fault.expected or said in fault.got for fault in caught.value.faults), caught.value.faults
    assert {fault.line for fault in caught.value.faults} == {line, text.count("\n")}


def test_an_emotion_that_is_missing_or_none_is_told(tmp_path):
    path = tmp_path / "envelopes.yaml"
    path.write_text(GOOD.replace("  disgust:", "  contempt:"))
    with pytest.raises(DataError) as caught:
        load_envelopes(path)
    assert {(fault.where, fault.expected) for fault in caught.value.faults} == {
        ("emotions.disgust", "this key"),
        ("emotions.contempt", "no such key"),
    }
