from __future__ import annotations

import pytest
from emotionml_documents import document, emotion, notes, times

from agentface.io.emotionml import read_emotionml


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ([{}, {}], [(0.0, 2.0), (2.0, 4.0)]),
        ([{"duration": 500}, {"duration": 0}, {}], [(0.0, 0.5), (0.5, 2.5), (2.5, 4.5)]),
        ([{"start": 1268647334000, "end": 1268647336500}, {}], [(0.0, 2.5), (2.5, 4.5)]),
        ([{"start": 9000}, {"start": 7000, "duration": 1000}], [(0.0, 1.0), (2.0, 4.0)]),
        ([{"start": 5000, "end": 5000}], [(0.0, 2.0)]),
        ([{"end": 5000, "duration": 1000}, {"end": 6000}], [(0.0, 1.0), (0.0, 2.0)]),
        ([{"start": 1, "end": 1001, "duration": 1000}], [(0.0, 1.0)]),
        ([{"offset_to_start": 3000}], [(3.0, 5.0)]),
        ([{"offset_to_start": -500}, {"offset_to_start": "+500"}], [(0.0, 2.0), (1.0, 3.0)]),
        ([{"id": "a", "duration": 700}, {"time_ref_uri": "#a", "offset_to_start": 100}], [(0.0, 0.7), (0.1, 2.1)]),
        ([{"id": "a"}, {"time_ref_uri": "#a", "time_ref_anchor_point": "end"}], [(0.0, 2.0), (2.0, 4.0)]),
        ([{"time_ref_uri": "#b", "offset_to_start": -400}, {"id": "b", "start": 8}], [(0.0, 2.0), (0.4, 2.4)]),
        ([{"time_ref_uri": "file:talk.avi", "offset_to_start": 1500}], [(1.5, 3.5)]),
        (
            [{"time_ref_uri": "#session", "time_ref_anchor_point": "end", "offset_to_start": -1000, "duration": 3000}],
            [(0.0, 3.0)],
        ),
        (
            [{}, {"time_ref_uri": "file:x", "time_ref_anchor_point": "end", "offset_to_start": 500}],
            [(0.0, 2.0), (0.5, 2.5)],
        ),
    ],
)
def test_times(said, expected):
    assert times(*(emotion(**attributes) for attributes in said)) == [pytest.approx(span) for span in sorted(expected)]


def test_a_long_chain_of_references():
    chain = [
        emotion(id=f"e{n}", duration=1, time_ref_uri=f"#e{n + 1}", time_ref_anchor_point="end") for n in range(3000)
    ]
    assert times(*chain, emotion(id="e3000", start=0, duration=1))[-1] == pytest.approx((3.0, 3.001))


@pytest.mark.parametrize(
    ("said", "expected"),
    [
        ([{"start": 5, "offset_to_start": 4}], [(0.0, 2.0)]),
        ([{"start": 5}, {"start": 1005, "time_ref_uri": "#none"}], [(0.0, 2.0), (1.0, 3.0)]),
        ([{"id": "a", "time_ref_uri": "#b"}, {"id": "b", "time_ref_uri": "#a"}], [(0.0, 2.0), (0.0, 2.0)]),
        ([{"id": "me", "time_ref_uri": "#me"}, {}], [(0.0, 2.0), (2.0, 4.0)]),
        ([{"duration": 7_200_000}], [(0.0, 3600.0)]),
        ([{"duration": "9" * 400}, {}], [(0.0, 3600.0)]),
        ([{"start": 0}, {"start": "1" * 30}], [(0.0, 2.0)]),
        ([{"offset_to_start": "-" + "1" * 30}, {"offset_to_start": 0}], [(0.0, 2.0)]),
    ],
)
def test_times_that_cannot_be_shown_as_they_are(said, expected):
    assert times(*(emotion(**attributes) for attributes in said)) == [pytest.approx(span) for span in expected]
    assert notes(*(emotion(**attributes) for attributes in said))


def test_an_emotion_that_shows_nothing_takes_its_time():
    relevance = '<appraisal name="relevance-person"/>'
    said = emotion(relevance, appraisal_set="http://www.w3.org/TR/emotion-voc/xml#scherer-appraisals")
    assert times(emotion(), said, emotion()) == [(0.0, 2.0), (4.0, 6.0)]
    assert read_emotionml(document(emotion(), said)).duration_s == 4.0


def test_slow_traces_are_shown_as_far_as_an_hour_goes():
    trace = '<category name="fear"><trace freq="0.0000001Hz" samples="0 1 0"/></category>'
    score = read_emotionml(document(emotion(trace)))
    assert (score.duration_s, len(score.notes)) == (3600.0, 1)
    assert score.state(3599.0)["fear"] == pytest.approx(0.0036, abs=1e-4)


def test_fast_traces_keep_their_last_sample():
    samples = " ".join(["0", "0.5"] * 50 + ["1"])
    (cue,) = read_emotionml(
        document(emotion(f'<category name="fear"><trace freq="45000Hz" samples="{samples}"/></category>'))
    ).cues
    assert (cue.samples[-1], cue.rate_hz) == (1.0, 9000.0)
    assert cue.end_s == pytest.approx(101 / 45000, abs=1 / 9000)
