"""Hearing while the sound comes: as good as on a recording, bounded, and the same every time."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from agentface.errors import InvalidValueError
from agentface.speech.hearing import heard
from agentface.speech.live_hearing import SURE_S, LiveHearing
from agentface.speech.voices.flite import Flite
from agentface.speech.voices.voice import SILENCE, Voiced
from tests.speech.test_hearing import TEXT, agreement
from tests.tools import require

RATE = 16_000


@pytest.fixture(scope="module")
def spoken():
    require("flite")
    return Flite().speak(TEXT)


@pytest.fixture(scope="module")
def hearing():
    pytest.importorskip("pocketsphinx")
    return LiveHearing()


def opinions(hearing, samples, step):
    """What it has heard of a sound whenever a piece has come: (seconds that have come, phones)."""
    hearing.begin()
    found = []
    for first in range(0, len(samples), step):
        hearing.feed(samples[first : first + step])
        found.append((min(first + step, len(samples)) / RATE, hearing.phones))
    hearing.end()
    found.append((np.inf, hearing.phones))
    return found


def known_later(found, by_s, length_s):
    """The phones as they were known so long after each instant."""
    phones = []
    for time in np.arange(0.0, length_s, 0.01) + 0.005:
        then = next(phones for came, phones in found if came >= time + by_s)
        phones += [phone for phone in then if phone.start_s <= time < phone.end_s]
    return phones


def test_what_is_known_a_moment_later_is_about_as_good_as_in_a_recording(hearing, spoken):
    found = opinions(LiveHearing(), spoken.sound.samples, 640)
    later = known_later(found, SURE_S, spoken.sound.duration_s)
    live = agreement(spoken, Voiced(spoken.sound, tuple(later)))
    assert live > 0.6
    assert live > agreement(spoken, heard(spoken.sound)) - 0.07


@pytest.mark.parametrize("step", [100, 1601])
def test_phones_have_no_gaps_and_reach_what_was_heard(hearing, spoken, step):
    for came, phones in opinions(hearing, spoken.sound.samples[: 2 * RATE], step):
        if phones:
            assert all(before.end_s == pytest.approx(after.start_s) for before, after in pairwise(phones))
        if np.isfinite(came):
            assert came - 0.011 < (phones[-1].end_s if phones else 0.0) <= came + 1e-6


def test_how_the_sound_is_cut_does_not_matter_in_the_end(spoken):
    ends = [opinions(LiveHearing(), spoken.sound.samples, step)[-1][1] for step in (160, 1600, 100_000)]
    shared = [{(p.symbol, round(p.start_s, 2)) for p in end} for end in ends]
    assert len(shared[0] & shared[1]) > 0.8 * len(shared[0])
    assert len(shared[0] & shared[2]) > 0.8 * len(shared[0])
    assert opinions(LiveHearing(), spoken.sound.samples, 160)[-1][1] == ends[0]


def test_silence_is_silence(hearing):
    for _, phones in opinions(hearing, np.zeros(RATE, np.int16), 800):
        assert {phone.symbol for phone in phones} <= {SILENCE}


@pytest.mark.slow
def test_a_long_sound_is_not_kept(hearing, spoken):
    """Half a minute of speech, and more: what it looks through each time stays short, and times go on."""
    samples = np.tile(spoken.sound.samples, 8)
    hearing.begin()
    most = 0
    for first in range(0, len(samples), 8000):
        hearing.feed(samples[first : first + 8000])
        most = max(most, len(hearing.phones))
    assert hearing.heard_s == pytest.approx(len(samples) / RATE, abs=0.02)
    assert hearing.phones[-1].end_s == pytest.approx(hearing.heard_s)
    assert most < 400
    assert len(hearing._energies) <= 30.0 / 0.01 + 50
    hearing.begin()
    assert hearing.heard_s == 0.0
    assert hearing.phones == ()


def test_it_knows_words_and_refuses_what_is_no_sound(hearing):
    assert hearing.pronounce("hello") == ("HH", "AH", "L", "OW")
    assert hearing.pronounce("zyxgorp") == ()
    for wrong in (np.zeros(10, np.float32), np.zeros((2, 5), np.int16)):
        with pytest.raises(InvalidValueError, match="int16"):
            hearing.feed(wrong)
