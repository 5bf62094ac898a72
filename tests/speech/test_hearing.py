from __future__ import annotations

import sys

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from agentface.errors import AgentFaceError, InvalidValueError, SpeechError
from agentface.speech.hearing import aligned, heard
from agentface.speech.sound import Sound
from agentface.speech.voices.flite import Flite
from agentface.speech.voices.voice import SILENCE, Voiced
from tests.tools import require

TEXT = "The birch canoe slid on the smooth planks. Glue the sheet to the dark blue background."
LABIALS, RATE = ("p", "b", "m"), 16_000


@pytest.fixture(scope="module")
def flite():
    require("flite")
    pytest.importorskip("pocketsphinx")
    return Flite()


@pytest.fixture(scope="module")
def spoken(flite):
    return flite.speak(TEXT)


def class_of(symbol: str) -> str:
    """Sounds that look alike on the lips, by the places of articulation in any textbook."""
    groups = {
        "lips": "p b m",
        "teeth": "f v",
        "round": "uw ow uh w ao oy",
        "wide": "iy ih eh ey ae y",
        "open": "aa ah ay aw ax",
    }
    return next((name for name, members in groups.items() if symbol.lower() in members.split()), "other")


def agreement(truth: Voiced, found: Voiced) -> float:
    """The share of speech, frame by frame, in which both have a sound of the same class."""
    times = np.arange(0.0, truth.sound.duration_s, 0.01) + 0.005

    def at(utterance: Voiced, time: float) -> str:
        return next((p.symbol for p in utterance.phones if p.start_s <= time < p.end_s), SILENCE)

    pairs = [(at(truth, time), at(found, time)) for time in times]
    return float(np.mean([class_of(a) == class_of(b) for a, b in pairs if a != SILENCE]))


def gapless(found: Voiced) -> bool:
    edges = [edge for phone in found.phones for edge in (phone.start_s, phone.end_s)]
    return edges[0] == 0.0 and edges[-1] == found.sound.duration_s and edges[1:-1:2] == edges[2:-1:2]


def test_the_phone_loop_hears_most_of_it(spoken):
    found = heard(spoken.sound)
    assert gapless(found)
    assert agreement(spoken, found) > 0.65
    assert heard(spoken.sound) == found


def test_a_text_is_aligned_to_a_few_frames(spoken, flite):
    found = aligned(spoken.sound, TEXT, flite.pronounce)
    assert gapless(found)
    assert agreement(spoken, found) > 0.85
    for kind in LABIALS:
        truth = [phone.start_s for phone in spoken.phones if phone.symbol == kind]
        there = [phone.start_s for phone in found.phones if phone.symbol.lower() == kind]
        assert there == pytest.approx(truth, abs=0.04)


def test_marks_are_at_the_words(flite):
    text = "Well, Zyxgorp paid $3.50 for it -- 'twice' and then left"
    marks = [0, 6, 14, 19, 25, 37, 99]
    truth = flite.speak(text, marks=marks)
    assert aligned(truth.sound, text, flite.pronounce, marks).marks_s == pytest.approx(truth.marks_s, abs=0.1)


def test_words_outside_of_the_dictionary_are_pronounced(flite):
    asked = []

    def pronounce(word):
        asked.append(word)
        return flite.pronounce(word)

    found = aligned(flite.speak("Hello Zyxgorp").sound, "Hello Zyxgorp", pronounce)
    assert asked == ["Zyxgorp"]
    assert [p.symbol for p in found.phones if p.symbol != SILENCE][4:] == [
        phone.upper() for phone in flite.pronounce("Zyxgorp")
    ]
    with pytest.raises(InvalidValueError, match="pronounce"):
        aligned(flite.speak("Hello").sound, "привет", flite.pronounce)


def test_what_is_not_the_text_is_one_error(spoken, flite):
    silence = Sound(np.zeros(RATE, np.int16), RATE)
    for sound, text in ((silence, "hello you"), (Sound(spoken.sound.samples[:3000], RATE), TEXT)):
        with pytest.raises(InvalidValueError, match="what is said"):
            aligned(sound, text, flite.pronounce)
    for text in ("", "...", "a " * 2001):
        with pytest.raises(InvalidValueError, match="words"):
            aligned(spoken.sound, text, flite.pronounce)


def test_silence_is_heard_as_silence_and_scraps_are_refused(flite):
    assert [phone.symbol for phone in heard(Sound(np.zeros(RATE, np.int16), RATE)).phones] == [SILENCE]
    for samples, rate in (
        (np.zeros(0, np.int16), RATE),
        (np.zeros(100, np.int16), RATE),
        (np.zeros(8000, np.int16), 8000),
    ):
        with pytest.raises(InvalidValueError, match="sound"):
            heard(Sound(samples, rate))


@settings(deadline=None, max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(
    seed=st.integers(0, 99),
    text=st.text(max_size=30),
    length=st.floats(0.1, 1.0),
    level=st.sampled_from((10, 3000, 32767)),
)
def test_noise_and_any_text_give_phones_or_one_error(seed, text, length, level, flite):
    samples = np.random.default_rng(seed).integers(-level, level, round(length * RATE)).astype(np.int16)
    assert gapless(heard(Sound(samples, RATE)))
    try:
        assert gapless(aligned(Sound(samples, RATE), text, flite.pronounce))
    except AgentFaceError:
        return


def test_a_missing_package_is_one_error_with_its_extra(monkeypatch, spoken):
    monkeypatch.setitem(sys.modules, "pocketsphinx", None)
    with pytest.raises(SpeechError, match=r'pip install "agentface\[speech\]"'):
        heard(spoken.sound)
