"""The picture of an explanation: its curves are scikit-fuzzy's, its words can be read."""

from __future__ import annotations

import json
from itertools import combinations, pairwise

import numpy as np
import pytest
import skfuzzy
from click.testing import CliRunner
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image, ImageDraw

from agentface.cli import cli
from agentface.emotion.explanation import explain
from agentface.emotion.mamdani import centroid
from agentface.emotion.rules import RuleBase
from agentface.emotion.sets import (
    CONTRACTION_CENTRES,
    CONTRACTION_HALF_WIDTH,
    CONTRACTION_SETS,
    INTENSITY_CENTRES,
    INTENSITY_HALF_WIDTH,
    contraction_membership,
    intensity_membership,
)
from agentface.emotion.sets import UNIVERSE as FUZZY_UNIVERSE
from agentface.emotion.state import EmotionState
from agentface.studies.rule_plot import aggregate, rule_plot

UNIVERSE = np.linspace(0.0, 1.0, 2001)
STATES = [
    {},
    {"anger": 1.0},
    {"happiness": 0.6, "surprise": 0.45},
    {"sadness": 0.6, "anger": 0.55, "fear": 0.5, "disgust": 0.5, "surprise": 0.4, "happiness": 0.37},
]


def explained(emotions):
    return explain(RuleBase.load(), EmotionState.of(emotions))


def triangles(centres, half_width, points=UNIVERSE):
    return np.array([skfuzzy.trimf(points, [c - half_width, c, c + half_width]) for c in centres])


def test_the_sets_are_scikit_fuzzy_s_triangles():
    contraction = triangles(CONTRACTION_CENTRES, CONTRACTION_HALF_WIDTH)
    np.testing.assert_allclose(contraction_membership(UNIVERSE), contraction, atol=1e-12)
    intensity = triangles(INTENSITY_CENTRES, INTENSITY_HALF_WIDTH)
    ours = np.array([intensity_membership(float(point)) for point in UNIVERSE]).T
    np.testing.assert_allclose(ours, intensity, atol=1e-12)


@given(st.lists(st.floats(0.05, 1.0), min_size=5, max_size=5), st.sets(st.integers(0, 4), min_size=1))
def test_the_aggregate_and_its_centroid_are_scikit_fuzzy_s(heights, active):
    cuts = {CONTRACTION_SETS[i]: heights[i] for i in active}
    reach = [CONTRACTION_HALF_WIDTH * (1.0 - heights[i]) for i in active]
    corners = [CONTRACTION_CENTRES[i] + side * r for i, r in zip(active, reach, strict=True) for side in (-1, 1)]
    for points in (UNIVERSE, np.union1d(FUZZY_UNIVERSE, corners)):
        expected = np.zeros_like(points)
        for i, set_ in enumerate(triangles(CONTRACTION_CENTRES, CONTRACTION_HALF_WIDTH, points)):
            if i in active:
                expected = np.fmax(expected, np.fmin(heights[i], set_))
        np.testing.assert_allclose(aggregate(cuts, points), expected, atol=1e-12)
    ours = centroid(np.array([cuts.get(name, 0.0) for name in CONTRACTION_SETS]))
    assert ours == pytest.approx(skfuzzy.defuzz(points, expected, "centroid"), abs=1e-9)


@pytest.mark.parametrize("emotions", STATES, ids=len)
def test_what_is_written_is_whole_and_nothing_lies_on_it(monkeypatch, emotions):
    boxes, inner = [], ImageDraw.ImageDraw.text

    def noted(self, place, text, **options):
        boxes.append((text, options["font"].getbbox(text), place, self.im.size))
        inner(self, place, text, **options)

    monkeypatch.setattr(ImageDraw.ImageDraw, "text", noted)
    explanation = explained(emotions)
    picture = rule_plot(explanation)
    assert picture.dtype == np.uint8
    assert picture.shape[1:] == (1448, 3)
    placed = []
    for text, (left, top, right, bottom), (x, y), (width, height) in boxes:
        placed.append((text, left + x, top + y, right + x, bottom + y))
        assert 0 <= left + x < right + x <= width, text
        assert 0 <= top + y < bottom + y <= height, text
    overlaps = [
        (one[0], other[0])
        for one, other in combinations(placed, 2)
        if one[1] < other[3] and other[1] < one[3] and one[2] < other[4] and other[2] < one[4]
    ]
    assert overlaps == []
    words = [text for text, *_ in placed]
    for mode in explanation.modes:
        assert f"{mode.name}, weight {mode.weight:.2f}" in words
        for outcome in mode.muscles:
            shown = f"{outcome.muscle}  {outcome.contraction:.2f}" in words
            named = any(outcome.muscle in word for word in words)
            assert shown if outcome.contraction > 0.0 else named
        for rule in mode.rules:
            outcome = next(outcome for outcome in mode.muscles if outcome.muscle == rule.muscle)
            told = f"{' and '.join(' '.join(pair) for pair in rule.premise)}: {rule.consequent}"
            assert told in words or outcome.contraction == 0.0


def test_a_rule_s_premise_says_what_its_text_says():
    for mode in explained({"happiness": 0.6, "surprise": 0.45}).modes:
        for rule in mode.rules:
            for emotion, name in rule.premise:
                assert f"{emotion.capitalize()} is {name}" in rule.text


def test_the_filled_area_is_the_aggregate():
    """In the first muscle's panel, the pale pixels of a column reach as high as the aggregate there."""
    explanation = explained({"anger": 1.0})
    picture = rule_plot(explanation).astype(int)
    pale = np.abs(picture - [226, 230, 238]).max(axis=2) < 3
    left, width, high = 28, 440, 104
    rows = np.flatnonzero(pale[:, left : left + width].any(axis=1))
    bottom = next(low for low, after in pairwise([*rows.tolist(), 10**6]) if after - low > 20)
    outcome = next(outcome for outcome in explanation.modes[0].muscles if outcome.contraction > 0.0)
    for place in (0.55, 0.65, 0.85, 0.95):
        column = pale[bottom - high : bottom + 1, left + round(place * width)]
        reached = high - np.flatnonzero(column)[0] if column.any() else 0
        expected = aggregate(outcome.cuts, np.array([place]))[0] * high
        assert reached == pytest.approx(expected, abs=8), place  # the outline lies over its edge


def call(*arguments, code=0):
    result = CliRunner().invoke(cli, ["explain", *map(str, arguments)], prog_name="agentface")
    assert result.exit_code == code, result.output
    return result


def test_the_command_draws(tmp_path):
    path = tmp_path / "why.png"
    assert call("happiness=0.6", "surprise=0.45", "--plot", path).output == ""
    with Image.open(path) as image:
        np.testing.assert_array_equal(np.asarray(image), rule_plot(explained({"happiness": 0.6, "surprise": 0.45})))
    told = call("anger=1", "--plot", path, "--json", "-").stdout
    assert json.loads(told)["modes"][0]["rules"][0]["premise"] == [["anger", "VeryHigh"]]


@pytest.mark.parametrize("name", ["why.txt", "no/such/why.png"])
def test_a_name_that_cannot_be_written_is_told_first(tmp_path, name):
    assert name in call("anger=1", "--plot", tmp_path / name, code=1).stderr
    assert list(tmp_path.iterdir()) == []
