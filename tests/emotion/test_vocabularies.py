from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner

from agentface.cli import cli
from agentface.config import load
from agentface.emotion.state import ALIASES, EMOTIONS
from agentface.emotion.vocabularies import (
    VocabulariesFile,
    Words,
    load_vocabularies,
    mixture_of,
    published,
    scales_with,
)
from agentface.errors import DataError
from agentface.resources import rules_file


def test_the_published_ones_are_as_long_as_the_note_says():
    assert {name: (vocabulary.type, len(vocabulary.names)) for name, vocabulary in published().items()} == {
        "big6": ("category", 6),
        "everyday-categories": ("category", 17),
        "occ-categories": ("category", 22),
        "fsre-categories": ("category", 24),
        "frijda-categories": ("category", 12),
        "pad-dimensions": ("dimension", 3),
        "fsre-dimensions": ("dimension", 4),
        "intensity-dimension": ("dimension", 1),
        "occ-appraisals": ("appraisal", 11),
        "scherer-appraisals": ("appraisal", 20),
        "ema-appraisals": ("appraisal", 12),
        "frijda-action-tendencies": ("action-tendency", 10),
    }


def test_a_name_of_one_of_the_six_is_that_emotion():
    for vocabulary in published().values():
        if isinstance(vocabulary, Words):
            for word, mixture in vocabulary.mixtures.items():
                emotion = ALIASES.get(word, word)
                assert emotion not in EMOTIONS or mixture == {emotion: 1.0}


# Where a sign is wrong, the face shows the opposite of what the word says.
PLEASANT = [
    "affectionate",
    "amused",
    "confident",
    "content",
    "excited",
    "interested",
    "loving",
    "pleased",
    "relaxed",
    "satisfied",
    "gratification",
    "gratitude",
    "happy-for",
    "hope",
    "love",
    "pride",
    "relief",
    "satisfaction",
    "contentment",
    "interest",
    "pleasure",
    "enjoyment",
    "desire",
]
UNPLEASANT = [
    "bored",
    "disappointed",
    "worried",
    "disappointment",
    "distress",
    "fears-confirmed",
    "hate",
    "pity",
    "remorse",
    "reproach",
    "resentment",
    "shame",
    "anxiety",
    "being-hurt",
    "contempt",
    "despair",
    "guilt",
    "irritation",
    "jealousy",
    "stress",
    "resignation",
]


@pytest.mark.parametrize("word", [*PLEASANT, *UNPLEASANT])
def test_what_is_pleasant_smiles_and_what_is_not_does_not(word):
    mixture = mixture_of(word)
    assert (max(mixture, key=mixture.get) == "happiness") == (word in PLEASANT)
    assert ("happiness" in mixture) == (word in PLEASANT)


def test_words_of_any_vocabulary():
    assert mixture_of("Rage") == {"anger": 1.0}
    assert mixture_of("neutral") == {"neutral": 1.0}
    assert mixture_of("boredom") is None
    assert mixture_of("neutral", "action-tendency") is None
    assert mixture_of("rejecting", "action-tendency") == {"disgust": 1.0}
    assert scales_with("arousal", "dimension") is published()["pad-dimensions"]
    assert scales_with("arousal", "appraisal") is None


def test_every_fault_of_the_file_is_told_with_its_line(tmp_path):
    path = tmp_path / "vocabularies.yaml"
    path.write_text(
        """columns: [happiness, sadness, anger, fear, disgust, surprise]
sources: {ours: ours}
vocabularies:
  a:
    type: mood
  b:
    type: category
    items:
      so so: {shows: {}, source: ours}
      x: {source: ours}
      y: {shows: {anger: 2}, source: ours}
      z: {pad: [0, 0], source: ours}
  c:
    type: dimension
    items:
      x: {scale: round, six: [0, 0, 0, 0, 0, 0], source: ours}
      y: {scale: bipolar, six: [0, 0, 0], source: ours}
others: 3
"""
    )
    with pytest.raises(DataError) as caught:
        load_vocabularies(path)
    assert {fault.line for fault in caught.value.faults} == {5, 9, 10, 11, 12, 16, 17, 18}
    assert CliRunner().invoke(cli, ["check", str(path)]).exit_code == 1
    assert CliRunner().invoke(cli, ["check", str(rules_file("vocabularies.yaml"))]).exit_code == 0


def test_faults_that_more_than_one_value_make(tmp_path):
    path = tmp_path / "vocabularies.yaml"
    path.write_text(
        """columns: [sadness]
sources: {ours: ours}
vocabularies:
  a:
    type: category
    items:
      x: {shows: {joy: 1}, source: ours}
      y: {pad: [0, 0, 0], source: theirs}
"""
    )
    with pytest.raises(DataError) as caught:
        load_vocabularies(path)
    assert [(fault.line, fault.where.split(".")[-1]) for fault in caught.value.faults] == [
        (1, "columns"), (7, "shows"), (8, "source"), (8, "pad"),
    ]  # fmt: skip


PAGE = Path(__file__).parents[2] / "docs" / "vocabularies.md"


def test_the_page_shows_every_row_of_the_file():
    rows = [[cell.strip() for cell in line.split("|")[1:-1]] for line in PAGE.read_text().splitlines()]
    told = {tuple(row[:2]): row[2:] for row in rows if row and row[0] in published()}
    assert len(told) == sum(len(vocabulary.names) for vocabulary in published().values())
    file = load(rules_file("vocabularies.yaml"), VocabulariesFile)
    for (name, word), cells in told.items():
        vocabulary, row = published()[name], file.vocabularies[name].items[word]
        assert cells[-1] == row.source
        if isinstance(vocabulary, Words):
            mixture = vocabulary.mixtures[word]
            assert cells[0] == (
                ", ".join(f"{emotion} {share:g}" for emotion, share in mixture.items()) or "a face at rest"
            )
        else:
            assert cells[:-1] == [row.scale, *(f"{place:g}" for place in row.six)]
    for source, words in file.sources.items():
        assert [source, words] in rows
