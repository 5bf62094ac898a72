from __future__ import annotations

import pytest
import yaml

from agentface.bml.table import bml_table, load_bml_table
from agentface.errors import DataError
from agentface.resources import rules_file

SHIPPED = rules_file("bml.yaml")
CHANGES = [
    (("times", "face"), [0.3, 1.0], "times.face: expected 3 times, got 2"),
    (("times", "smile"), [1.0], "times.smile: expected no such key"),
    (("times", "gaze"), None, "times.gaze: expected this key"),
    (("times", "wait"), [0], "times.wait.0: expected greater than or equal to 0.01"),
    (("lexemes", "SMILE"), {}, "lexemes.SMILE: expected action_units or emotions, got neither"),
    (("lexemes", "SMILE"), {"emotions": {"hapiness": 1.0}}, "did you mean happiness"),
    (("lexemes", "SMILE"), {"emotions": {"happiness": 1.0}, "side": "left"}, "none beside emotions"),
    (("lexemes", "FROWN"), {"action_units": {3: 1.0}}, "lexemes.FROWN.action_units.3: expected an action unit"),
    (("lexemes", "frown"), {"action_units": {4: 1.0}}, "lexemes.frown: expected FROWN"),
    (("heads", "NOD", "gesture"), "nodd", "did you mean nod"),
    (("heads", "NOD", "at"), [0.1, 0.2, 0.15, 0.5, 0.6], "parts that grow"),
    (("targets", "LEFT", "yaw_deg"), 90, "targets.LEFT.yaw_deg: expected less than or equal to 75"),
    (("influences", "EYES"), 2, "influences.EYES: expected less than or equal to 1"),
]


@pytest.mark.parametrize(("where", "value", "expected"), CHANGES)
def test_a_wrong_value_is_told_with_its_line(tmp_path, where, value, expected):
    data = yaml.safe_load(SHIPPED.read_text())
    inner = data
    for key in where[:-1]:
        inner = inner[key]
    if value is None:
        del inner[where[-1]]
    else:
        inner[where[-1]] = value
    path = tmp_path / "bml.yaml"
    path.write_text(yaml.safe_dump(data))
    with pytest.raises(DataError) as caught:
        load_bml_table(path)
    told = str(caught.value)
    assert expected in told, told
    assert told.startswith(f"{path}:")


def test_the_shipped_table_has_the_standard_s_words():
    table = bml_table()
    assert {"NOD", "SHAKE", "TILT"} <= table.heads.keys()
    assert {"EYES", "HEAD", "SHOULDER", "WAIST", "WHOLE"} == table.influences.keys()
    assert {"RAISE_BROWS", "LOWER_BROWS", "OBLIQUE_BROWS", "SMILE", "OPEN_MOUTH"} <= table.lexemes.keys()
    left = {(show.what, show.side) for show in table.lexemes["RAISE_LEFT_BROW"]}
    right = {(show.what, show.side) for show in table.lexemes["RAISE_RIGHT_BROW"]}
    assert left == {(what, "l") for what, _ in right}
