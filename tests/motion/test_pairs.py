"""Pairs of muscles that look wrong together: none of the two begins before the other is gone."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from agentface.emotion.inference import default_inference
from agentface.emotion.state import EmotionState
from agentface.motion.conflicts import default_conflicts
from agentface.motion.emotion import EmotionChannel
from agentface.motion.pairs import Pairs, held_back_in_numpy
from agentface.motion.pairs_compiled import held_back
from agentface.parameters import MUSCLES
from tests.motion.test_emotions_in_time import contractions, run

COUNT = 6
NONE = Pairs(np.zeros(0, np.int32), np.zeros(0, np.int32), np.zeros((0, 2)))
LEVELS = arrays(np.float64, COUNT, elements=st.floats(0, 1))
ZYGOMATICUS, DEPRESSOR = (MUSCLES.index(name) for name in ("zygomaticus_major", "depressor_anguli_oris"))


@st.composite
def pairs(draw):
    named = draw(st.lists(st.permutations(range(COUNT)).map(lambda order: tuple(order[:2])), max_size=4))
    places = np.array(named, np.int32).reshape(-1, 2)
    priorities = draw(arrays(np.float64, places.shape, elements=st.integers(1, 100)))
    return Pairs(places[:, 0].copy(), places[:, 1].copy(), priorities)


def held(wanted, start, target, table, how=held_back):
    out = np.full((len(wanted), wanted.shape[1]), np.nan)
    how(wanted, start, target, table, out)
    return out


@given(arrays(np.float64, (3, COUNT), elements=st.floats(0, 1)), LEVELS, LEVELS, pairs())
def test_the_kernel_equals_its_numpy_twin(wanted, start, target, table):
    kernel, plain = (held(wanted, start, target, table, how) for how in (held_back, held_back_in_numpy))
    np.testing.assert_allclose(kernel, plain, atol=1e-12)


@given(LEVELS, LEVELS, LEVELS, pairs())
def test_of_a_pair_one_is_always_nothing_more_than_it_may(wanted, start, target, table):
    left = wanted - held(wanted[None], start, target, table)[0]
    for first, second in zip(table.first, table.second, strict=True):
        for going, coming in ((first, second), (second, first)):
            goes, comes = max(left[going] - target[going], 0.0), max(left[coming] - start[coming], 0.0)
            assert min(goes, comes) < 1e-12


@given(LEVELS, LEVELS, pairs())
def test_where_a_change_begins_and_ends_nothing_is_held_back(start, target, table):
    assert not held(np.stack([start, target]), start, target, table).any()


@given(LEVELS, LEVELS, LEVELS, pairs())
def test_nothing_is_held_back_below_nothing(wanted, start, target, table):
    back = held(wanted[None], start, target, table)[0]
    assert (back >= 0.0).all()
    assert (back <= wanted).all()


@pytest.mark.parametrize(("mine", "others"), [(80, 40), (40, 40), (20, 40)])
def test_priority_is_time(mine, others):
    table = Pairs(np.array([0], np.int32), np.array([1], np.int32), np.array([[mine, others]], np.float64))
    share = np.linspace(0.0, 1.0, 601)
    start, target = np.array([1.0, 0.0]), np.array([0.0, 1.0])
    wanted = start + share[:, None] * (target - start)
    left = wanted - held(wanted, start, target, table)
    # the one goes at a share of r / (1 + r) of the change, where r is the ratio of the priorities
    assert share[np.argmax(left[:, 1] > 1e-9)] == pytest.approx(mine / (mine + others), abs=2e-3)


CHANGES = [
    ({"happiness": 1.0}, {"anger": 1.0}, None),
    ({"anger": 1.0}, {"happiness": 1.0}, None),
    ({"happiness": 1.0}, {"sadness": 1.0}, 0.5),
    ({"sadness": 0.7}, {"happiness": 0.8}, 1.0),
    ({"surprise": 1.0}, {"anger": 1.0}, 0.6),
]


@pytest.mark.parametrize(("before", "after", "fade"), CHANGES)
def test_in_a_change_of_emotions_the_one_is_gone_before_the_other_begins(before, after, fade):
    table = default_conflicts().pairs
    together = {}
    for name, used in (("with", table), ("without", NONE)):
        channel = EmotionChannel(default_inference(), pairs=used)
        channel.change(EmotionState.of(before), 0.0, None)
        channel.change(EmotionState.of(after), fade, None)
        path = run(channel, 3.0, 0.01)
        overlap = np.minimum(path[:, table.first], path[:, table.second])
        settled = np.minimum(*(default_inference().contractions(after)[places] for places in table[:2]))
        together[name] = (overlap - settled).max()
        np.testing.assert_array_equal(contractions(channel), default_inference().contractions(after))
    assert together["without"] > 0.15
    assert together["with"] < 0.07  # what the rounding of the corners leaves


def test_what_the_rules_ask_of_both_at_once_stays():
    both = Pairs(np.array([ZYGOMATICUS], np.int32), np.array([DEPRESSOR], np.int32), np.array([[60.0, 40.0]]))
    state = next(
        state
        for first in np.linspace(0.3, 1.0, 8)
        for second in np.linspace(0.3, 1.0, 8)
        for state in [EmotionState.of(happiness=first, disgust=second)]
        if default_inference().contractions(state)[[ZYGOMATICUS, DEPRESSOR]].min() > 0.2
    )
    expected = default_inference().contractions(state)
    channel = EmotionChannel(default_inference(), pairs=both)
    channel.change(state, 0.5, None)
    channel.advance(0.5)
    np.testing.assert_array_equal(contractions(channel), expected)
    channel.change(state, 0.5, None)
    channel.change({"fear": 0.0}, 0.5, None)
    assert (run(channel, 1.0, 0.01) == expected).all()


def test_a_brief_smile_sends_the_corners_down_away_and_back():
    channel = EmotionChannel(default_inference())
    channel.change_mood(EmotionState.of(sadness=0.5), 0.0)
    channel.change({"happiness": 1.0}, 0.4, 0.6)
    path = run(channel, 3.0, 0.005)[:, [ZYGOMATICUS, DEPRESSOR]]
    smiles, falls = path.T
    assert falls[0] > 0.4
    assert falls[np.argmax(smiles > 0.1)] < 0.02, "gone before the smile begins"
    assert smiles.max() > 0.7
    last = len(smiles) - np.argmax(smiles[::-1] > 0.1)
    assert falls[last - 1] < 0.02, "back when the smile is gone"
    assert falls[-1] == pytest.approx(falls[0])
