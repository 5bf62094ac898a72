from __future__ import annotations

import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.emotion.state import ALIASES, EMOTIONS
from agentface.errors import DataError
from agentface.io.emotion_vocabularies import is_id, load_vocabularies, published, shown_as
from agentface.resources import rules_file


def test_the_published_ones_are_as_long_as_the_note_says():
    counts = {name: len(names) for name, names in published().items()}
    assert counts == {
        "big6": 6, "everyday-categories": 17, "occ-categories": 22, "fsre-categories": 24, "frijda-categories": 12,
    }  # fmt: skip
    assert sorted(published()["big6"]) == sorted(EMOTIONS)
    assert all(list(names) == sorted(names) for names in published().values())


def test_what_a_category_is_shown_as():
    assert {shown_as(name) for name in (*EMOTIONS, *ALIASES)} == set(EMOTIONS)
    assert shown_as("Angry") == "anger"
    assert shown_as("neutral") == "neutral"
    assert shown_as("bored") is None


@pytest.mark.parametrize(
    ("text", "good"), [("a", True), ("_1.b-c", True), ("é", True), ("1a", False), ("", False), ("a b", False)]
)
def test_ids(text, good):
    assert is_id(text) is good


def test_every_fault_of_the_file_is_told_with_its_line(tmp_path):
    path = tmp_path / "vocabularies.yaml"
    path.write_text("categories:\n  a: [one, one]\n  b: []\n  c d: [x]\n  e: [so so]\nothers: 3\n")
    with pytest.raises(DataError) as caught:
        load_vocabularies(path)
    assert {fault.line for fault in caught.value.faults} == {2, 3, 4, 5, 6}
    assert CliRunner().invoke(cli, ["check", str(path)]).exit_code == 1
    assert CliRunner().invoke(cli, ["check", str(rules_file("vocabularies.yaml"))]).exit_code == 0
