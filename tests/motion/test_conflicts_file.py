from __future__ import annotations

import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.errors import DataError
from agentface.motion.conflicts import CHANNELS, load_conflicts
from agentface.parameters import MUSCLES
from agentface.resources import rules_file

GOOD = rules_file("conflicts.yaml").read_text()


def faults_of(path):
    with pytest.raises(DataError) as caught:
        load_conflicts(path)
    return caught.value.faults


def test_the_table_that_comes_along_is_good_and_has_every_channel():
    conflicts = load_conflicts(rules_file("conflicts.yaml"))
    assert all(0 <= conflicts.rank(name).priority <= 100 for name in CHANNELS)
    assert CliRunner().invoke(cli, ["check", str(rules_file("conflicts.yaml"))]).exit_code == 0


def test_every_fault_is_told_at_once_with_its_line(tmp_path):
    text = GOOD
    for old, new in (
        ("  emotion: {priority: 10}", "  emotion: {priority: 101}"),
        ("  gaze: {priority: 10}", "  gaze: {priority: 10, way: sum}"),
        ("  head: {priority: 10}", "  haed: {priority: 10}"),
        ("{levator_palpebrae: scale}", "{levator_palpebra: scale, mouht: max, eyes: most}"),
        ("{priority: 90, way: replace}", "{way: replace, weight: 1}"),
        ("others: {priority: 45}", "others: {priorities: {jaw_open: high}}"),
    ):
        assert old in text
        text = text.replace(old, new)
    path = tmp_path / "conflicts.yaml"
    path.write_text(text)
    lines = text.splitlines()

    def line_of(part):
        return next(number for number, line in enumerate(lines, start=1) if part in line)

    found = {(fault.where, fault.line) for fault in faults_of(path)}
    assert found == {
        ("channels.emotion.priority", line_of("emotion: {")),
        ("channels.gaze.way", line_of("way: sum")),
        ("channels.haed", line_of("haed")),
        ("channels.head", line_of("channels:")),
        ("channels.blink.ways.levator_palpebra", line_of("levator_palpebra:")),
        ("channels.blink.ways.mouht", line_of("mouht")),
        ("channels.blink.ways.eyes", line_of("eyes: most")),
        ("channels.muscles.priority", line_of("weight: 1")),
        ("channels.muscles.weight", line_of("weight: 1")),
        ("others.priority", line_of("others:")),
        ("others.priorities.jaw_open", line_of("jaw_open: high")),
    }
    hints = {fault.where: fault.hint + fault.expected for fault in faults_of(path)}
    assert "head" in hints["channels.haed"]
    assert "levator_palpebrae" in hints["channels.blink.ways.levator_palpebra"]
    assert "mouth" in hints["channels.blink.ways.mouht"]
    said = CliRunner().invoke(cli, ["check", str(path)])
    assert said.exit_code == 1
    assert "11 faults" in said.output


@pytest.mark.parametrize("text", ["", "channels: 3\nothers: {priority: 1}\n", "- a\n"])
def test_another_form_is_a_fault(tmp_path, text):
    path = tmp_path / "conflicts.yaml"
    path.write_text(text)
    assert faults_of(path)


@pytest.mark.parametrize(
    ("row", "said"),
    [
        ("{muscles: {risorius: 60, risorios: 40}, reason: x}", "risorius"),
        ("{muscles: {risorius_l: 60, mentalis: 40}, reason: x}", "without its side"),
        ("{muscles: {risorius: 60}, reason: x}", "2"),
        ("{muscles: {risorius: 60, mentalis: 40, nasalis: 20}, reason: x}", "2"),
        ("{muscles: {risorius: 0, mentalis: 101}, reason: x}", "100"),
        ("{muscles: {risorius: 60, mentalis: 40}}", "this key"),
        ("{muscles: {depressor_anguli_oris: 60, zygomaticus_major: 40}, reason: x}", "once"),
    ],
)
def test_a_pair_is_two_muscles_with_priorities_once(tmp_path, row, said):
    path = tmp_path / "conflicts.yaml"
    path.write_text(f"{GOOD}  - {row}\n")
    assert any(said in f"{fault}" for fault in faults_of(path))
    assert {fault.line for fault in faults_of(path)} == {path.read_text().count("\n")}


def test_pairs_may_be_left_out(tmp_path):
    path = tmp_path / "conflicts.yaml"
    path.write_text(GOOD[: GOOD.index("pairs:")])
    assert load_conflicts(path).pairs.first.size == 0
    table = load_conflicts(rules_file("conflicts.yaml")).pairs
    assert MUSCLES[table.first[0]] == "zygomaticus_major"
    assert table.priorities[0].tolist() == [60.0, 40.0]
