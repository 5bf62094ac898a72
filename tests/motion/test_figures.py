from __future__ import annotations

import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.errors import DataError
from agentface.motion.figures import STATES, load_life
from agentface.motion.gestures.table import all_gestures
from agentface.resources import rules_file

GOOD = rules_file("life.yaml").read_text()


def test_the_table_that_comes_along_is_good_and_names_gestures_that_there_are():
    table = load_life(rules_file("life.yaml"))
    assert set(table.states) == set(STATES)
    assert {name for row in table.states.values() for name in row.gestures} <= set(all_gestures())
    assert CliRunner().invoke(cli, ["check", str(rules_file("life.yaml"))]).exit_code == 0


def test_every_fault_is_told_at_once_with_its_line(tmp_path):
    text = GOOD
    for old, new in (
        ("natural: 0.6", "natural: 0"),
        ("  thinking:", "  dreaming:"),
        ("close_s: [0.075, 0.1]", "close_s: [0.1, 0.075]"),
        ("half: 0.12", "half: 1.2"),
        ("blinks_per_minute: 26", "blinks_per_minute: many"),
        ("lag_s: 0.03", "lag_ms: 30"),
        ("directions: {0: 15.54,", "directions: {360: 15.54,"),
    ):
        assert old in text
        text = text.replace(old, new, 1)
    path = tmp_path / "life.yaml"
    path.write_text(text)
    lines = text.splitlines()

    def line_of(part):
        return next(number for number, line in enumerate(lines, start=1) if part in line)

    with pytest.raises(DataError) as caught:
        load_life(path)
    assert {(fault.where, fault.line) for fault in caught.value.faults} >= {
        ("dial.natural", line_of("natural: 0")),
        ("states.dreaming", line_of("dreaming")),
        ("states.thinking", line_of("states:")),
        ("blinks.close_s", line_of("close_s")),
        ("blinks.half", line_of("half: 1.2")),
        ("states.speaking.blinks_per_minute", line_of("minute: many")),
        ("sides.lag_ms", line_of("lag_ms")),
        ("sides.lag_s", line_of("sides:")),
    }


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ("over: 15.7", "over: 14", "saccades.largest_p"),
        ("eyes_keep: 0.6", "eyes_keep: 0.95", "look_at.eyes_keep"),
        ("at_s: 0.9", "at_s: 0.1", "states.thinking.at_s"),
        ("smallest_deg: 5.0", "smallest_deg: 30.0", "states.thinking.smallest_deg"),
        ("apart_s: 0.6", "apart_s: 3.0", "states.speaking.blinks_per_minute"),
    ],
)
def test_figures_that_do_not_go_together_are_faults(tmp_path, old, new, where):
    path = tmp_path / "life.yaml"
    assert old in GOOD
    path.write_text(GOOD.replace(old, new, 1))
    with pytest.raises(DataError) as caught:
        load_life(path)
    assert where in {fault.where for fault in caught.value.faults}


@pytest.mark.parametrize("text", ["", "dial: 3\n", "- a\n"])
def test_another_form_is_a_fault(tmp_path, text):
    path = tmp_path / "life.yaml"
    path.write_text(text)
    with pytest.raises(DataError):
        load_life(path)
