from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.speech import coarticulation, coarticulation_compiled
from agentface.speech.alphabets import phone_table
from agentface.speech.articulation import default_articulation
from agentface.speech.phones import phones_of
from agentface.speech.timeline import segments_of, timeline_of

ARTICULATION = default_articulation()
SOUNDS = ["p", "f", "th", "t", "k", "ch", "s", "n", "r", "aa", "eh", "ih", "iy", "ao", "uw", "ay", "pau", "hh", "ax"]
GAPS = st.just(0.0) | st.floats(0.02, 0.3)
SAYINGS = st.lists(st.tuples(st.sampled_from(SOUNDS), st.floats(0.02, 0.4), GAPS), min_size=1, max_size=6)


def laid_out(saying, start=0.0, loudness=1.0):
    """The timeline of sounds, each with its length and the gap before it."""
    rows = []
    for symbol, length, gap in saying:
        rows.append((symbol, start + gap, start + gap + length))
        start += gap + length
    looks = phone_table().looks([row[0] for row in rows], "arpabet")
    return timeline_of(segments_of(phones_of(rows), looks, ARTICULATION.rules.rate.normal_s), ARTICULATION, loudness)


def shown(timeline, times):
    """``(T, P + 2)``."""
    out, weights = np.zeros((len(times), ARTICULATION.size)), np.zeros(len(ARTICULATION.articulators))
    for row, time in zip(out, times, strict=True):
        coarticulation_compiled.sample(timeline, ARTICULATION.ramps, time, weights, row)
    return out


def column(name):
    return ARTICULATION.names.index(name)


@given(SAYINGS, st.lists(st.floats(-1, 4), min_size=1, max_size=5))
def test_the_kernel_says_what_its_twin_says(saying, times):
    timeline, out = laid_out(saying), np.full(ARTICULATION.size, 9.0)
    for time in times:
        coarticulation.sample(timeline, ARTICULATION.ramps, time, out)
        np.testing.assert_allclose(out, shown(timeline, [time])[0], atol=1e-12)


def test_a_value_by_hand():
    # two sounds of 0.1 s, written out with the numbers of the table: aa from 0 to 0.1, s to 0.2, silence around
    timeline = laid_out([("aa", 0.1, 0), ("s", 0.1, 0)])
    rules, time = ARTICULATION.rules, 0.13
    visemes = {name: ARTICULATION._table[name] for name in ("sil", "aa", "SS")}
    rate = rules.rate.normal_s / 0.1
    weights, values = [], []
    for name, start, end in (("sil", -4, 0), ("aa", 0, 0.1), ("SS", 0.1, 0.2), ("sil", 0.2, 4.2)):
        strength, before, after = visemes[name].dominance["jaw"]
        away = time - ((start + end) / 2 - visemes[name].early_s)
        far = max(0, abs(away) - max(rules.middle * (end - start), (end - start) / 2 - rules.edge_s))
        speed = (before if away < 0 else after) * (1 if name == "sil" else math.sqrt(rate))
        weights.append(strength * math.exp(-speed * (math.hypot(far, rules.round_s) - rules.round_s)))
        values.append(visemes[name].shares.get("jaw_open", 0.0) * rate**rules.rate.jaw_power)
    expected = sum(w * v for w, v in zip(weights, values, strict=True)) / sum(weights)
    assert shown(timeline, [time])[0][ARTICULATION.jaw] == pytest.approx(expected, rel=1e-9)


@given(SAYINGS)
def test_nothing_leaves_the_targets_that_it_lies_between(saying):
    timeline = laid_out(saying)
    values = shown(timeline, np.arange(-0.5, 3, 0.05))
    count = len(ARTICULATION.names)
    low, high = timeline.targets.min(axis=0), timeline.targets.max(axis=0)
    assert (values[:, :count] >= np.minimum(low, 0) - 1e-9).all()
    assert (values[:, :count] <= np.maximum(high, 0) + 1e-9).all()
    assert (values[:, count:] >= 0).all()
    assert (values[:, -1] <= 1 + 1e-12).all()


@given(SAYINGS, st.floats(0, 100))
def test_later_is_the_same_later(saying, later):
    times = np.arange(-0.3, 2, 0.11)
    np.testing.assert_allclose(
        shown(laid_out(saying), times), shown(laid_out(saying, start=later), times + later), atol=1e-6
    )


@given(SAYINGS)
def test_there_is_no_jump_and_no_corner(saying):
    timeline = laid_out(saying)
    step = 1e-3
    values = shown(timeline, np.arange(-0.3, sum(length + gap for _, length, gap in saying) + 0.3, step))
    speed = np.diff(values, axis=0) / step
    assert np.abs(speed).max() < 60.0
    # a corner would leave steps of speed as large however short the time between
    assert np.abs(np.diff(speed, axis=0)).max() < 4.0


@pytest.mark.parametrize(
    ("symbol", "name"), [("aa", "jaw_open"), ("uw", "orbicularis_oris_pucker"), ("iy", "risorius")]
)
def test_a_long_vowel_is_what_its_viseme_says(symbol, name):
    timeline = laid_out([("pau", 0.3, 0), (symbol, 1.0, 0), ("pau", 0.3, 0)])
    viseme = phone_table().looks([symbol], "arpabet")[0][0].visemes[0][0]
    expected = ARTICULATION._table[viseme].shares[name]
    if name == "jaw_open":
        expected *= ARTICULATION.rules.rate.jaw_most
    assert shown(timeline, [0.8])[0][column(name)] == pytest.approx(expected, rel=0.02)


def test_rounding_begins_before_the_vowel_and_spreads_over_consonants():
    timeline = laid_out([("s", 0.1, 0), ("t", 0.08, 0), ("uw", 0.15, 0)])
    pucker = shown(timeline, [0.09, 0.14, 0.235])[:, column("orbicularis_oris_pucker")]
    assert pucker[0] > 0.1 * pucker[2]
    assert pucker[1] > 0.4 * pucker[2]


def test_quick_and_low_speech_opens_less():
    def opening(length, loudness):
        timeline = laid_out([("t", length, 0), ("aa", length, 0), ("t", length, 0)], loudness=loudness)
        return shown(timeline, np.arange(0, 3 * length, 0.005))[:, ARTICULATION.jaw].max()

    assert opening(0.06, 1) < opening(0.1, 1) < opening(0.2, 1)
    assert opening(0.1, 0.4) < opening(0.1, 1) < opening(0.1, 1.8)


def test_speaking_lasts_from_the_first_sound_to_the_last():
    timeline = laid_out([("pau", 0.5, 0), ("aa", 0.2, 0), ("t", 0.2, 0), ("pau", 0.5, 0)])
    speaking = shown(timeline, [0.2, 0.5, 0.7, 0.9, 1.2])[:, -1]
    np.testing.assert_allclose(speaking, [0, 1, 1, 1, 0], atol=1e-12)


def test_the_jaw_is_kept_while_a_sibilant_is_said():
    timeline = laid_out([("aa", 0.2, 0), ("s", 0.1, 0), ("aa", 0.2, 0)])
    assert shown(timeline, [0.25])[0][-2] == pytest.approx(math.log(1 + 1 / ARTICULATION._table["SS"].jaw_most))
    assert shown(timeline, [0.05])[0][-2] == 0


@given(SAYINGS, SAYINGS)
def test_what_comes_later_than_it_reaches_changes_nothing(saying, later):
    known = laid_out(saying)
    rest = [(later[0][0], later[0][1], later[0][2] + 2.5), *later[1:]]
    end = sum(length + gap for _, length, gap in saying)
    np.testing.assert_allclose(
        shown(known, [0.0, 0.5 * end]), shown(laid_out([*saying, *rest]), [0.0, 0.5 * end]), atol=1e-9
    )
