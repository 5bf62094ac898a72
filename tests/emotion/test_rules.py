from __future__ import annotations

import re
from itertools import combinations, pairwise
from pathlib import Path

import numpy as np
import pytest

from agentface.emotion.rules import RuleBase
from agentface.emotion.state import EMOTIONS
from agentface.emotion.tables import load_blends, load_emotions
from agentface.errors import DataError, Fault
from agentface.parameters import MUSCLES


def spoil(file: Path, *changes: tuple[str, str]) -> None:
    text = file.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    file.write_text(text, encoding="utf-8")


def faults_of(folder: Path) -> tuple[Fault, ...]:
    with pytest.raises(DataError) as caught:
        RuleBase.load(folder)
    return caught.value.faults


def line_of(file: Path, text: str) -> int:
    return next(number for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1) if text in line)


def test_every_emotion_and_every_pair_has_its_mode(rulebase: RuleBase):
    assert [mode.emotions for mode in rulebase.modes[:6]] == [(emotion,) for emotion in EMOTIONS]
    assert [mode.emotions for mode in rulebase.modes[6:]] == list(combinations(EMOTIONS, 2))
    assert all(mode.description and mode.source for mode in rulebase.modes)


def test_every_rule_table_is_gentle(rulebase: RuleBase):
    for mode in rulebase.modes:
        for muscle, rules in mode.consequents.items():
            assert muscle in MUSCLES
            assert rules.shape == (5,) * len(mode.emotions)
            assert rules[(0,) * rules.ndim] == 0
            assert all(np.abs(np.diff(rules.astype(int), axis=axis)).max() <= 2 for axis in range(rules.ndim))


@pytest.mark.parametrize(
    ("emotion", "muscles"),
    {
        "happiness": ("zygomaticus_major", "orbicularis_oculi_lateralis"),  # AU 12, 6
        "sadness": ("frontalis_medialis", "corrugator_supercilii", "depressor_anguli_oris"),  # AU 1, 4, 15
        "anger": (
            "corrugator_supercilii",
            "levator_palpebrae",
            "orbicularis_oris_press",
        ),
        "fear": ("frontalis_medialis", "frontalis_lateralis", "corrugator_supercilii", "levator_palpebrae", "risorius"),
        "disgust": ("levator_labii_superioris_alaeque_nasi", "levator_labii_superioris"),  # AU 9, 10
        "surprise": ("frontalis_medialis", "frontalis_lateralis", "levator_palpebrae", "jaw_open"),  # AU 1, 2, 5, 26
    }.items(),
)
def test_the_prototypes_of_emfacs_are_in_the_rules(rulebase: RuleBase, emotion: str, muscles: tuple[str, ...]):
    rules = rulebase.mode((emotion,)).consequents
    assert all(rules[muscle].max() >= 2 for muscle in muscles)


def test_lids_tighten_in_anger_and_the_eyes_stay_open(rulebase: RuleBase):
    rules = rulebase.mode(("anger",)).consequents
    assert rules["orbicularis_oculi_preseptalis"].max() >= 3  # AU 7, which leaves the eyes open
    assert not {"orbicularis_oculi_palpebralis", "orbicularis_oculi_orbitalis"} & rules.keys()


def test_each_emotion_grows_with_its_intensity(rulebase: RuleBase, gives_way: set[tuple[str, str]]):
    for mode in rulebase.modes[:6]:
        for muscle, rules in mode.consequents.items():
            if (*mode.emotions, muscle) not in gives_way:
                assert all(high >= low for low, high in pairwise(rules.tolist())), (mode.emotions, muscle)


def test_the_parts_of_a_blend_follow_their_emotions(rulebase: RuleBase):
    blend = rulebase.mode(("sadness", "fear")).consequents
    sadness, fear = (rulebase.mode((emotion,)).consequents for emotion in ("sadness", "fear"))
    assert (blend["frontalis_medialis"] == sadness["frontalis_medialis"][:, None]).all()
    assert (blend["risorius"] == fear["risorius"][None, :]).all()
    stronger = np.maximum(sadness["corrugator_supercilii"][:, None], fear["corrugator_supercilii"][None, :])
    assert (blend["corrugator_supercilii"] == stronger).all()
    assert (blend["depressor_anguli_oris"] == np.minimum(sadness["depressor_anguli_oris"][:, None], 2)).all()
    assert "frontalis_lateralis" not in blend


def test_a_pair_may_be_named_in_any_order_and_by_aliases(rules_folder: Path, rulebase: RuleBase):
    spoil(rules_folder / "blends.yaml", ("  sadness+fear:", "  afraid+sad:"), ("upper: sadness", "upper: sad"))
    changed = RuleBase.load(rules_folder)
    for mode in rulebase.modes:
        for muscle, rules in mode.consequents.items():
            assert (changed.mode(mode.emotions).consequents[muscle] == rules).all()


def test_all_faults_of_both_files_come_at_once_with_their_lines(rules_folder: Path):
    emotions, blends = rules_folder / "emotions.yaml", rules_folder / "blends.yaml"
    spoil(
        emotions,
        ("      zygomaticus_major: ", "      zygomaticus_mayor: "),
        ("[VerySmall, Small,     Small, ", "[VerySmall, Little,    Small, "),
        ("  surprise:", "  astonishment:"),
    )
    spoil(
        blends,
        ("      risorius: fear", "      risorius: joi"),
        ("  happiness+surprise:", "  happiness+happiness:"),
        ("    - platysma", "    - platisma"),
    )
    found = {(fault.file.name, fault.line) for fault in faults_of(rules_folder)}
    assert found == {
        ("emotions.yaml", line_of(emotions, "zygomaticus_mayor")),
        ("emotions.yaml", line_of(emotions, "Little")),
        ("emotions.yaml", line_of(emotions, "astonishment:")),
        ("emotions.yaml", line_of(emotions, "emotions:")),  # no surprise
        ("blends.yaml", line_of(blends, "risorius: joi")),
        ("blends.yaml", line_of(blends, "happiness+happiness")),
        ("blends.yaml", line_of(blends, "blends:")),  # no happiness+surprise
        ("blends.yaml", line_of(blends, "- platisma")),
        ("blends.yaml", line_of(blends, "groups:")),  # none for platysma
    }


@pytest.mark.parametrize(
    ("row", "expected"),
    [
        ("[Small, Small, Medium, Big, VeryBig]", "VerySmall at VeryLow"),
        ("[VerySmall, Small, Big, VeryBig, VeryBig]", "neighbours one set apart"),
        ("[VerySmall, Big, Big, VeryBig, VeryBig]", "neighbours one set apart"),
        ("[VerySmall, Small, Medium, Big]", "at least 5 items"),
        ("[VerySmall, Small, Medium, Big, VeryBig, VeryBig]", "at most 5 items"),
        ("[VerySmall, Small, Medium, 4, VeryBig]", "VeryBig"),
        ("Big", "list"),
    ],
)
def test_a_row_that_would_make_the_face_jump_is_refused(rules_folder: Path, row: str, expected: str):
    file = rules_folder / "emotions.yaml"
    text, changed = re.subn(
        r"zygomaticus_major: +\[.*\]", f"zygomaticus_major: {row}", file.read_text("utf-8"), count=1
    )
    assert changed
    file.write_text(text, encoding="utf-8")
    (fault,) = faults_of(rules_folder)
    assert expected in str(fault)
    assert fault.line == line_of(file, "zygomaticus_major")


@pytest.mark.parametrize(
    ("old", "new", "expected"),
    [
        ("gap: 0.2", "gap: 0.05", "greater than or equal to 0.2"),
        ("gap: 0.2", "gap: .nan", "finite"),
        ("    - platysma\n", "", "none for platysma"),
        ("    - platysma\n", "    - platysma\n    - procerus\n", "each muscle in one group"),
        ("  happiness+sadness:", "  sadness+anger:", "each key once"),
        ("  happiness+sadness:", "  anger+sadness:", "each pair of emotions once"),
        ("  happiness+sadness:", "  happiness+sadness+fear:", "two emotions joined by +"),
        ("    upper: sadness\n", "    upper: disgust\n", "happiness or sadness, stronger or rest"),
        ("    upper: sadness\n", "", "this key"),
        ("at_most: Medium", "at_most: Middle", "'Medium'"),
        ("{from: stronger, at_most", "{from: fear, at_most", "happiness or surprise"),
        ("  gap: 0.2", "  gap: 0.2\n  threshold: 0.1", "no such key"),
    ],
)
def test_a_fault_of_the_blends_is_told(rules_folder: Path, old: str, new: str, expected: str):
    spoil(rules_folder / "blends.yaml", (old, new))
    assert any(expected in str(fault) for fault in faults_of(rules_folder))
    assert all(fault.line is not None for fault in faults_of(rules_folder))


def test_the_columns_are_the_intensity_sets_in_order(rules_folder: Path):
    spoil(rules_folder / "emotions.yaml", ("[VeryLow, Low, Medium,", "[Low, VeryLow, Medium,"))
    (fault,) = faults_of(rules_folder)
    assert fault.where == "columns"


@pytest.mark.parametrize("text", ["", "[]", "emotions: 3", "blends: [a]\ngroups: [b]\nselector: 1", "5", "? [a]\n: b"])
def test_a_file_of_another_kind_is_refused(rules_folder: Path, text: str):
    for name in ("emotions.yaml", "blends.yaml"):
        (rules_folder / name).write_text(text, encoding="utf-8")
    assert {fault.file.name for fault in faults_of(rules_folder)} == {"emotions.yaml", "blends.yaml"}


def test_a_missing_file_is_named(tmp_path: Path):
    assert {fault.file.name for fault in faults_of(tmp_path)} == {"emotions.yaml", "blends.yaml"}


def test_each_file_is_checked_alone(rules_folder: Path):
    (rules_folder / "blends.yaml").unlink()
    assert load_emotions(rules_folder / "emotions.yaml").emotions.fear.description
    with pytest.raises(DataError):
        load_blends(rules_folder / "blends.yaml")
