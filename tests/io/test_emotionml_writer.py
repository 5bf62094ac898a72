from __future__ import annotations

import numpy as np
import pytest
from emotionml_documents import faults
from hypothesis import given
from hypothesis import strategies as st

from agentface.emotion.score import Cue, Score
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.errors import InvalidValueError
from agentface.io.emotionml import read_emotionml
from agentface.io.emotionml_writer import write_emotionml

LEVELS = st.floats(0.0, 1.0).map(lambda level: round(level, 6))


@st.composite
def cues(draw):
    start = draw(st.integers(0, 5000))
    end = start + draw(st.integers(1, 5000))
    samples = draw(st.lists(LEVELS, min_size=1, max_size=5))
    rate = draw(st.floats(0.01, 1000.0)) if len(samples) > 1 else 0.0
    return Cue(draw(st.sampled_from([*EMOTIONS, "neutral"])), start / 1000, end / 1000, tuple(samples), rate)


@given(st.lists(cues(), max_size=6), st.floats(0.0, 12.0))
def test_what_is_written_is_read(shown, lasts_s):
    score = Score(shown, lasts_s=lasts_s)
    again = read_emotionml(write_emotionml(score).encode(), strict=bool(shown))
    assert again.cues[: len(shown)] == pytest.approx(score.cues) or again.duration_s > max(cue.end_s for cue in shown)
    for time in np.linspace(0.0, score.duration_s, 20):
        assert again.state(time).array == pytest.approx(score.state(time).array, abs=2e-6)
    if shown or lasts_s > 0.001:
        assert again.duration_s == pytest.approx(score.duration_s, abs=0.0011)


def test_what_begins_and_ends_together_is_one_emotion():
    score = Score(
        [Cue("fear", 1.0, 2.0, (0.5,)), Cue("anger", 1.0, 2.0), Cue("anger", 1.0, 2.0, (0.25,)), Cue("fear", 1.0, 3.0)]
    )
    text = write_emotionml(score, reference="file:film.mp4?a&b", info="<made> by hand\x00")
    assert text.count("<emotion ") == 3
    assert text.count('time-ref-uri="file:film.mp4?a&amp;b"') == 3
    assert "<info>&lt;made&gt; by hand</info>" in text
    assert read_emotionml(text.encode(), strict=True).cues == score.cues


def test_the_document_of_one_emotion():
    assert write_emotionml(Score([Cue("fear", 0.0, 1.5, (0.25,))])).splitlines() == [
        '<?xml version="1.0" encoding="UTF-8"?>',
        '<emotionml version="1.0" xmlns="http://www.w3.org/2009/10/emotionml"'
        ' category-set="http://www.w3.org/TR/emotion-voc/xml#big6">',
        '  <emotion offset-to-start="0" duration="1500">',
        '    <category name="fear" value="0.25"/>',
        "  </emotion>",
        "</emotionml>",
    ]


def test_a_score_of_nothing():
    text = write_emotionml(Score())
    assert "<emotion " not in text
    assert read_emotionml(text.encode()).cues == ()
    assert faults(text.replace("1.0", "2.0").encode())


def test_states_over_time():
    states = np.random.default_rng(0).uniform(0.0, 1.0, (50, 6))
    states[:, 2] = 0.0
    score = Score.sampled(states, 25.0)
    again = read_emotionml(write_emotionml(score).encode())
    assert {cue.emotion for cue in again.cues} == set(EMOTIONS) - {"anger"}
    assert again.duration_s == 2.0
    for frame, state in enumerate(states):
        assert again.state(frame / 25.0).array == pytest.approx(state, abs=1e-6)


def test_states_at_rest_last_as_long():
    score = Score.sampled(np.zeros((50, 6)), 25.0)
    again = read_emotionml(write_emotionml(score).encode())
    assert (again.duration_s, again.state(1.0)) == (2.0, EmotionState())


@pytest.mark.parametrize(
    ("states", "rate", "what"),
    [
        (np.zeros((2, 5)), 25.0, "states"),
        (np.zeros((0, 6)), 25.0, "states"),
        (np.zeros((2, 6)), 0.0, "rate_hz"),
        (np.full((2, 6), 2.0), 25.0, "sample"),
        (np.full((2, 6), np.nan), 25.0, "sample"),
        (np.zeros((2, 6)), 1e-9, "lasts_s"),
    ],
)
def test_states_that_are_none(states, rate, what):
    with pytest.raises(InvalidValueError, match=what):
        Score.sampled(states, rate)
