"""The channel of speech: turns, live streams, hush, single visemes, and that nothing jumps."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.errors import UnknownNameError
from agentface.motion.conflicts import default_conflicts
from agentface.motion.speech import GRACE_S, HUSH_S, SpeechChannel
from agentface.motion.yielding import Yielding
from agentface.parameters import parameter
from agentface.speech.articulation import default_articulation
from agentface.speech.phones import Phone, phones_of

SOUNDS = ["p", "f", "th", "t", "k", "ch", "s", "n", "r", "aa", "eh", "ih", "iy", "ao", "uw", "ay", "pau"]
ARTICULATION = default_articulation()
TOP = 75.0
"""1/s, what no parameter goes faster than: a contact comes in 70 ms by half a cosine, beside a rest that goes."""


def saying(*lengths, sound="aa"):
    """Phones that last so long, silence in every second place."""
    phones, start = [], 0.0
    for number, length in enumerate(lengths):
        phones.append(Phone("pau" if number % 2 else sound, start, start + length))
        start += length
    return phones


def shown(channel, felt=0.0):
    """What the channel makes of a face that feels ``felt`` everywhere."""
    values, weights = np.zeros(len(channel.names)), np.ones(len(channel.names))
    if channel.write(values, weights) is False:
        return np.full(len(values), felt)
    return weights * values + (1.0 - weights) * felt


def jaw(channel, felt=0.0):
    return shown(channel, felt)[channel.names.index("jaw_open")]


def pass_(channel, seconds, step=1 / 60):
    for _ in range(round(seconds / step)):
        channel.advance(step)


def test_nothing_is_wanted_before_and_after_speech():
    channel = SpeechChannel(compiled=False)
    values, weights = np.zeros(len(channel.names)), np.ones(len(channel.names))
    assert channel.write(values, weights) is False
    channel.speak(saying(0.2))
    pass_(channel, 0.2)
    assert channel.write(values, weights)
    pass_(channel, 3.0)
    assert channel.write(values, weights) is False


def test_a_second_waits_its_turn_and_each_end_is_told_once():
    channel, ends = SpeechChannel(compiled=False), []
    channel.ended.append(lambda: ends.append(round(channel._now, 6)))
    channel.speak(saying(0.5))
    channel.speak(saying(0.25), start=0.1, rate=2.0)
    assert channel.status == {"phone": "aa", "ends_in_s": 0.5, "waiting": 1}
    channel.advance(0.55)
    assert channel.status == {"phone": None, "ends_in_s": 0.175, "waiting": 0}
    channel.advance(1.0)
    assert channel.status is None
    assert ends == [0.5, 0.725]


def test_interrupting_drops_what_is_said_and_what_waits():
    channel, ends = SpeechChannel(compiled=False), []
    channel.ended.append(lambda: ends.append(channel.speaking))
    for _ in range(3):
        channel.speak(saying(0.5))
    channel.speak(saying(0.3, sound="uw"), interrupt=True)
    assert ends == [False] * 3
    assert channel.status == {"phone": "uw", "ends_in_s": 0.3, "waiting": 0}


def test_who_is_told_of_an_end_may_speak_at_once():
    channel, said = SpeechChannel(compiled=False), []

    def again():
        said.append(channel._now)
        if len(said) < 3:
            channel.speak(saying(0.1))

    channel.ended.append(again)
    channel.speak(saying(0.1))
    channel.advance(1.0)
    assert said == pytest.approx([0.1, 0.2, 0.3])


@pytest.mark.parametrize("felt", [0.0, 0.6])
def test_hush_gives_the_mouth_back_in_time(felt):
    channel = SpeechChannel(compiled=False)
    channel.speak(saying(2.0))
    pass_(channel, 0.5)
    assert jaw(channel) > 0.2
    channel.hush()
    assert channel.status is None
    pass_(channel, HUSH_S + 0.01, 0.005)
    np.testing.assert_allclose(shown(channel, felt), felt, atol=1e-9)
    pass_(channel, 2.0)
    np.testing.assert_allclose(shown(channel, felt), felt, atol=1e-9)


def test_hush_also_drops_what_waits_and_single_visemes():
    channel = SpeechChannel(compiled=False)
    channel.speak(saying(0.5))
    channel.speak(saying(0.5))
    channel.show("aa", 1.0)
    channel.hush()
    pass_(channel, 0.2)
    assert channel.status is None
    assert jaw(channel) == pytest.approx(0.0, abs=1e-9)


def test_a_live_stream_that_comes_in_time_shows_what_is_known_beforehand():
    sounds = [("aa", 0.12), ("p", 0.08), ("iy", 0.1), ("s", 0.09), ("uw", 0.14), ("m", 0.07), ("eh", 0.12)] * 2
    ends = np.cumsum([length for _, length in sounds])
    phones = phones_of([(symbol, end - length, end) for (symbol, length), end in zip(sounds, ends, strict=True)])
    whole, live = (SpeechChannel(compiled=False) for _ in range(2))
    whole.speak(phones, start=0.2)
    worst, waiting, now = np.zeros(len(whole.names)), list(phones), 0.0
    while waiting or live.speaking:
        due = [phone for phone in waiting if phone.start_s + 0.2 - now <= 0.2]  # 200 ms ahead
        if due:
            live.speak([Phone(p.symbol, p.start_s + 0.2 - now, p.end_s + 0.2 - now) for p in due], live=True)
            waiting = waiting[len(due) :]
        for channel in (whole, live):
            channel.advance(1 / 60)
        now += 1 / 60
        worst = np.maximum(worst, np.abs(shown(whole) - shown(live)))
    by_name = dict(zip(whole.names, worst.tolist(), strict=True))
    assert by_name["jaw_open"] < 0.08
    for name in ARTICULATION.contacts:
        assert by_name[name] < 0.02


def test_a_revision_counts_from_its_first_phone_on():
    channel = SpeechChannel(compiled=False)
    channel.speak(saying(1.0), live=True)
    channel.advance(0.3)
    channel.speak([Phone("uw", 0.2, 0.6)], live=True)
    assert channel.status == {"phone": "aa", "ends_in_s": 0.6, "waiting": 0}
    channel.advance(0.3)
    assert channel.status["phone"] == "uw"
    channel.advance(0.35)
    assert channel.status == {"phone": None, "ends_in_s": 0.0, "waiting": 0}
    channel.advance(GRACE_S)
    assert channel.status is None


def test_what_is_told_once_more_changes_nothing_though_its_times_are_rounded():
    """As when the same phones are told from another moment: they begin a hair later than those they replace."""
    once, often = (SpeechChannel(compiled=False) for _ in range(2))
    for channel in (once, often):
        channel.speak(saying(0.2, 0.05, 0.2, 0.1, 0.3), live=True)
    for _ in range(30):
        now = 0.01
        for channel in (once, often):
            channel.advance(now)
        told = [Phone(p.symbol, p.start_s, p.end_s) for p in often._current._phones]
        shift = often._current.began - often._now + 1e-12
        often.speak([Phone(p.symbol, p.start_s + shift, p.end_s + shift) for p in told], live=True)
        assert len(often._current._phones) == len(once._current._phones)
        assert shown(often) == pytest.approx(shown(once), abs=0.02)


def test_live_phones_wait_behind_what_is_not_live():
    channel = SpeechChannel(compiled=False)
    channel.speak(saying(1.0))
    channel.speak([Phone("uw", 0.0, 0.3)], live=True)
    assert channel.status == {"phone": "aa", "ends_in_s": 1.0, "waiting": 1}


def test_a_viseme_comes_holds_and_goes():
    channel = SpeechChannel(compiled=False)
    channel.show("aa", 0.5)
    pass_(channel, 1.0)
    half = jaw(channel)
    channel.show("aa", 1.0, 0.5)
    pass_(channel, 0.4)
    assert jaw(channel) == pytest.approx(2 * half, rel=0.01)
    pass_(channel, 0.4)
    assert jaw(channel) == 0.0
    channel.show("oh", 1.0)
    channel.show("aa", 1.0)
    pass_(channel, 0.3)
    both = jaw(channel)
    channel.show("oh", 0.0)
    pass_(channel, 0.3)
    assert jaw(channel) != pytest.approx(both, abs=0.02)
    channel.release(0.2)
    pass_(channel, 0.3)
    assert jaw(channel) == 0.0


def test_unknown_names_are_told_and_nothing_happens():
    channel = SpeechChannel(compiled=False)
    with pytest.raises(UnknownNameError, match="phone"):
        channel.speak([Phone("aa", 0, 1), Phone("xyzzy", 1, 2)], interrupt=True)
    with pytest.raises(UnknownNameError, match="viseme"):
        channel.show("xyzzy", 1.0)
    assert channel.status is None


@pytest.mark.parametrize("felt", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("sound", ["s", "z", "sh", "p", "f"])
def test_the_jaw_keeps_to_its_limit_whatever_is_felt(sound, felt):
    channel = SpeechChannel(compiled=False)
    channel.speak([Phone("aa", 0.0, 0.2), Phone(sound, 0.2, 0.3), Phone("aa", 0.3, 0.5)], start=0.3)
    limit = {"s": "SS", "z": "SS", "sh": "CH", "p": "PP", "f": "FF"}[sound]
    pass_(channel, 0.55, 0.01)
    assert jaw(channel, felt) <= ARTICULATION._table[limit].jaw_most + 1e-9


@given(
    st.lists(st.floats(0, 1), min_size=ARTICULATION.size, max_size=ARTICULATION.size),
    st.floats(0, 1),
    st.booleans(),
)
def test_what_is_shown_is_speech_and_what_is_left_of_what_is_felt(sample, felt, compiled):
    yields = default_conflicts().yields
    yielding = Yielding(ARTICULATION, yields, compiled=compiled)
    values, weights = np.zeros(len(yielding.names)), np.zeros(len(yielding.names))
    sample = np.array(sample)
    yielding.write(sample, values, weights)
    got = dict(zip(yielding.names, weights * values + (1 - weights) * felt, strict=True))
    said = dict(zip(ARTICULATION.names, sample[:-2].tolist(), strict=True))
    a = sample[-1]
    r, c = (1 - math.prod(1 - said[name] for name in names) for names in (yields.rounds, yields.closes))
    for name, value in got.items():
        plain = name[:-2] if parameter(name).partner else name
        speaking, rounding, closure = yields.shares.get(plain, (0, 0, 0))
        x = said.get(plain, 0.0)
        whole = x + (1 - abs(x)) * (1 - speaking * a) * (1 - rounding * r) * (1 - closure * c) * felt
        if plain == "jaw_open":
            assert value <= min(whole, 1 / math.expm1(max(sample[-2], 1e-9))) + 1e-9
            assert value >= 0.0
        else:
            assert value == pytest.approx(whole, abs=1e-9)


@given(st.lists(st.floats(-2, 2), min_size=ARTICULATION.size, max_size=ARTICULATION.size))
def test_the_kernel_of_yielding_equals_its_numpy_twin(sample):
    twins = [Yielding(ARTICULATION, default_conflicts().yields, compiled=how) for how in (True, False)]
    wanted = np.full((2, 2, len(twins[0].names)), np.nan)
    for yielding, (values, weights) in zip(twins, wanted, strict=True):
        yielding.write(np.array(sample), values, weights)
    np.testing.assert_allclose(wanted[0], wanted[1], atol=1e-12)


def test_with_no_limit_the_jaw_is_as_open_as_both_make_it():
    yields = default_conflicts().yields
    yielding, kept = Yielding(ARTICULATION, yields), 1.0 - yields.shares["jaw_open"][0]
    values, weights = np.zeros(len(yielding.names)), np.zeros(len(yielding.names))
    sample = np.zeros(ARTICULATION.size)
    sample[ARTICULATION.jaw], sample[-1] = 0.3, 1.0
    yielding.write(sample, values, weights)
    place = yielding.names.index("jaw_open")
    assert weights[place] * values[place] + (1 - weights[place]) * 0.5 == pytest.approx(
        0.3 + 0.7 * kept * 0.5, rel=0.02
    )


PHONES = st.lists(st.tuples(st.sampled_from(SOUNDS), st.floats(0.03, 0.3)), min_size=1, max_size=6)
DEEDS = st.one_of(
    st.tuples(st.just("speak"), PHONES, st.sampled_from([0.0, 0.2]), st.sampled_from([0.6, 1.6]), st.booleans()),
    st.tuples(st.just("live"), PHONES, st.sampled_from([0.0, 0.2])),
    st.tuples(st.just("hush")),
    st.tuples(
        st.just("show"), st.sampled_from(["aa", "PP", "ou", "sil"]), st.floats(0, 1), st.none() | st.floats(0, 1)
    ),
)
SCRIPT = st.lists(st.tuples(DEEDS, st.integers(1, 4)), min_size=1, max_size=8)
"""Deeds, and how many sixths of a second pass after each."""


def do(channel, deed):
    kind, *rest = deed
    if kind in ("speak", "live"):
        phones, start = [], 0.0
        for symbol, length in rest[0]:
            phones.append(Phone(symbol, start, start + length))
            start += length
        if kind == "live":
            channel.speak(phones, start=rest[1], live=True)
        else:
            channel.speak(phones, start=rest[1], rate=rest[2], interrupt=rest[3])
    elif kind == "show":
        channel.show(*rest)
    else:
        channel.hush()


def played(script, steps):
    """What is shown six times a second, with ``steps`` frames from one time to the next."""
    channel, rows = SpeechChannel(), []
    for deed, times in script:
        do(channel, deed)
        for _ in range(times):
            for _ in range(steps):
                channel.advance(1 / (6 * steps))
            rows.append(shown(channel, 0.4))
    return np.array(rows)


@settings(max_examples=25)
@given(SCRIPT)
def test_frame_rates_agree_and_the_same_is_the_same(script):
    first = played(script, 5)
    assert (played(script, 5) == first).all()
    for steps in (10, 24):
        np.testing.assert_allclose(played(script, steps), first, atol=1e-3)


@settings(max_examples=25)
@given(SCRIPT)
def test_nothing_jumps_whatever_interrupts_what(script):
    channel, step = SpeechChannel(), 1e-3
    before = shown(channel, 0.4)
    for deed, times in script:
        do(channel, deed)
        np.testing.assert_allclose(shown(channel, 0.4), before, atol=1e-9)
        for _ in range(50 * times):
            channel.advance(step)
            now = shown(channel, 0.4)
            assert np.abs(now - before).max() < TOP * step
            before = now
