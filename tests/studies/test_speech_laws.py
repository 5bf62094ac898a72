"""The laws of a speaking mouth, on a fair part of what ``agentface bench speech`` measures."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

from agentface.face import Face
from agentface.head.model import load_model
from agentface.resources import face_names
from agentface.speech.phones import Phone
from agentface.studies import speech_laws
from agentface.studies.harvard import harvard
from agentface.studies.mouth_ruler import MouthRuler
from agentface.studies.speech_laws import LAWS, STATES, Manner, SpeakingMouth, broken

FEW = (harvard()[5], harvard()[14], harvard()[19])
"""Sentences that have every sound the laws speak of, and many p, b, m, f."""
HURRIED = ((1.6, 1.8), (1.6, 0.4), (0.6, 1.8))
MANNERS = ((1.0, 1.0), *HURRIED, (0.6, 0.4))


@cache
def mouth(face):
    return SpeakingMouth(load_model(face), "geometric")


def test_the_sentences_are_the_lists_and_follow_one_another():
    assert len(harvard()) == 20
    said = [phone.symbol for sentence in harvard() for phone in sentence.phones]
    assert sum(symbol in speech_laws.LIPS_SHUT for symbol in said) == 35
    assert sum(symbol in speech_laws.LIP_BITTEN for symbol in said) == 22
    for sentence in harvard():
        assert sentence.phones[0].start_s == 0.0
        assert all(
            before.end_s == after.start_s < after.end_s
            for before, after in zip(sentence.phones, sentence.phones[1:], strict=False)
        )


def test_these_few_sentences_have_all_that_the_laws_speak_of():
    said = {phone.symbol for sentence in FEW for phone in sentence.phones}
    assert {"p", "b", "m", "f", "v", "aa", "ih", "iy", "uw", "s"} <= said


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("face", face_names())
@pytest.mark.parametrize("state", STATES[:7], ids=lambda state: "+".join(state) or "neutral")
def test_the_laws_hold_under_every_emotion(face, state):
    figures = mouth(face).figures(Manner(state), FEW)
    assert broken(figures) == []
    assert ("smile_kept" in figures) == ("happiness" in state)
    assert figures.keys() | {"smile_kept"} == LAWS.keys()


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("face", face_names())
@pytest.mark.parametrize(("rate", "loudness"), HURRIED)
def test_they_hold_for_the_quick_and_the_slow_the_loud_and_the_low(face, rate, loudness):
    for state in ({"happiness": 1.0}, {"surprise": 1.0}):
        assert broken(mouth(face).figures(Manner(state, rate, loudness), FEW)) == []


@pytest.mark.soak
@pytest.mark.timeout(7200)
@pytest.mark.parametrize("face", face_names())
def test_they_hold_for_every_two_emotions_in_every_manner(face):
    for state in STATES:
        for rate, loudness in MANNERS:
            assert broken(mouth(face).figures(Manner(state, rate, loudness))) == []


def test_a_mouth_that_does_not_close_breaks_them(monkeypatch):
    face = mouth(face_names()[0])
    measure = face._ruler.measure
    monkeypatch.setattr(
        face._ruler, "measure", lambda geometry, *, bite: measure(geometry, bite=bite)._replace(gap=2.0)
    )
    found = broken(face.figures(Manner({}), FEW[:1]))
    assert [fault.partition(":")[0] for fault in found] == ["gap_in_pbm_mm", "shut_least", "shut_most", "gap_in_aa_mm"][
        : len(found)
    ]
    assert len(found) >= 3


@pytest.mark.slow
@pytest.mark.untraced
@pytest.mark.parametrize("face", face_names())
def test_tissue_reaches_the_closures(face):
    model = load_model(face)
    spoken, ruler = Face(model, deformer="tissue"), MouthRuler(model)
    spoken.set_emotion("happiness", 1.0, fade=0.0)
    spoken.step(0.5)
    phones = [Phone("aa", 0.0, 0.15), Phone("p", 0.15, 0.25), Phone("aa", 0.25, 0.4), Phone("f", 0.4, 0.5)]
    spoken.speak(phones, start=0.1)
    gaps, bites = [], []
    for frame in range(36):
        geometry, time = spoken.step(1 / 60), (frame + 1) / 60 - 0.1
        measures = ruler.measure(geometry, bite=0.4 <= time <= 0.5)
        if 0.12 <= time <= 0.28:
            gaps.append(measures.gap)
        bites.append(measures.bite)
    assert min(gaps) <= speech_laws.SHUT_MM
    assert np.nanmin(bites) <= speech_laws.BITTEN_MM
    assert max(gaps) > 1.0
