from __future__ import annotations

import pytest

from agentface.commands.check import faults_of
from agentface.resources import rules_file
from agentface.speech.visemes import VISEME_COUNT, load_visemes, viseme_table, visemes

GOOD = rules_file("visemes.yaml").read_text()


def test_the_fifteen_come_first_and_others_have_no_number():
    table = viseme_table()
    assert [viseme.number for viseme in table.numbered] == list(range(VISEME_COUNT))
    assert table.numbered == visemes()
    others = [table[name] for name in list(table)[VISEME_COUNT:]]
    assert "iy" in table
    assert {viseme.number for viseme in others} == {None}
    assert all(viseme.values.any() for viseme in others)


@pytest.mark.parametrize(
    ("old", "new", "where"),
    [
        ("    name: iy", "    name: ih", "more.0.name"),
        ("    name: TH", "    name: DD", "visemes.4.name"),
        ("  14:", "  15:", "visemes.15"),
        ("name: iy", "nam: iy", "more.0.nam"),
        ("risorius: 0.94", "risorius: 1.94", "more.0.parameters.risorius"),
    ],
)
def test_faults_are_told_where_they_are(tmp_path, old, new, where):
    assert old in GOOD
    path = tmp_path / "visemes.yaml"
    path.write_text(GOOD.replace(old, new, 1))
    assert where in {fault.where for fault in faults_of(path)}


def test_another_table_can_be_read():
    assert list(load_visemes(rules_file("visemes.yaml"))) == list(viseme_table())
