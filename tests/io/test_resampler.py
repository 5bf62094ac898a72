"""Sound in pieces at another rate: scipy's polyphase filter on the whole is the second opinion."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface.errors import InvalidValueError
from agentface.io.resampler import Resampler
from agentface.speech.sound import Sound


def fed(resampler, samples, edges):
    parts = [resampler.feed(part) for part in np.split(samples, edges)]
    return np.concatenate([*parts, resampler.end()])


def tones(seconds, rate):
    times = np.arange(round(seconds * rate)) / rate
    return (6000 * np.sin(2 * np.pi * 300 * times) + 4000 * np.sin(2 * np.pi * 1700 * times)).astype(np.int16)


@settings(max_examples=10)
@given(
    rate=st.sampled_from([8000, 11_025, 22_050, 24_000, 44_100, 48_000]),
    to=st.sampled_from([8000, 16_000, 24_000, 48_000]),
    cuts=st.lists(st.integers(0, 7900), max_size=6),
)
def test_it_sounds_like_the_whole_however_it_is_cut(rate, to, cuts):
    samples = tones(1.0, rate)
    got = fed(Resampler(rate, 1, to), samples, sorted(cuts))
    assert len(got) == to
    expected = Sound(samples, rate).at_rate(to).samples
    middle = slice(len(got) // 10, -len(got) // 10)
    assert np.abs(got[middle].astype(int) - expected[middle]).max() < 150


@given(st.lists(st.integers(0, 1000), max_size=5))
def test_its_own_rate_passes_through(cuts):
    samples = np.random.default_rng(0).integers(-32768, 32767, 1000).astype(np.int16)
    assert np.array_equal(fed(Resampler(16_000, 1, 16_000), samples, sorted(cuts)), samples)


def test_little_of_it_comes_later():
    resampler, came = Resampler(24_000, 1, 16_000), 0
    for number in range(1, 50):
        came += len(resampler.feed(np.zeros(480, np.int16)))
        assert number * 320 - came <= 32


def test_channels_are_mixed_and_another_sound_begins_anew():
    left, right = np.full(100, 1000, np.int16), np.full(100, -400, np.int16)
    resampler = Resampler(16_000, 2, 16_000)
    assert set(resampler.feed(np.column_stack([left, right]).ravel())) == {300}
    other = Resampler(8000, 1, 16_000)
    first = fed(other, tones(0.5, 8000), [])
    assert np.array_equal(fed(other, tones(0.5, 8000), []), first)


@pytest.mark.parametrize(
    "wrong",
    [(0, 1, 16_000), (16_000, 0, 16_000), (16_000, 9, 16_000), (True, 1, 16_000), (8e3, 1, 16_000), (8000, 1, 10)],
)
def test_wrong_rates_and_channels_are_refused(wrong):
    with pytest.raises(InvalidValueError):
        Resampler(*wrong)
    for samples in (np.zeros(3, np.int16), np.zeros(4, np.float64), np.zeros((2, 2), np.int16)):
        with pytest.raises(InvalidValueError, match="int16"):
            Resampler(16_000, 2, 8000).feed(samples)
