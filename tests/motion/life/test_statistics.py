"""Five minutes and an hour of life in a simulated clock: what can be counted in the poses is what the table says."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from agentface.motion.figures import STATES, default_life
from agentface.parameters import HIGH, LOW, NAMES, parameter
from tests.motion.living import channels, trace

pytestmark = pytest.mark.untraced

HZ = 200
FIVE_MINUTES, HOUR = 300.0, 3600.0
TABLE = default_life()
CLOSER = [parameter(f"orbicularis_oculi_palpebralis_{side}").index for side in "lr"]
GAZE = [parameter(name).index for name in ("gaze_yaw", "gaze_pitch")]
HEAD = [parameter(name).index for name in ("head_yaw", "head_pitch")]
SEEN_DEG = 1.0
"""Smaller leaps are not told from drift here."""


@dataclass
class Blink:
    start_s: float
    depth: float
    closing_s: float
    opening_s: float
    alone: bool


@dataclass
class Leap:
    time_s: float
    way_deg: np.ndarray
    seconds: float

    @property
    def size(self):
        return float(np.hypot(*self.way_deg))


@cache
def seen(state: str, seconds: float = FIVE_MINUTES) -> tuple[list[Blink], list[Leap], np.ndarray, np.ndarray]:
    poses = trace(channels(seed=3, state=state), seconds, HZ)
    world = np.degrees(poses[:, GAZE] + poses[:, HEAD])
    return blinks_of(poses[:, CLOSER[0]]), leaps_of(world), poses.min(0), poses.max(0)


def blinks_of(closure: np.ndarray) -> list[Blink]:
    """Each time that the lids close, from one standstill or least closure to the next."""
    found, shut = [], np.flatnonzero((closure[1:] > 0) & (closure[:-1] == 0)) + 1
    for start in shut:
        end = start + int(np.argmax(closure[start:] == 0))
        part = closure[start:end]
        tops = np.flatnonzero((part[1:-1] >= part[:-2]) & (part[1:-1] > part[2:])) + 1
        for top in tops:
            level = part[top]
            before, after = part[: top + 1], part[top:]
            rising = np.flatnonzero(before < 0.99 * level)
            closing = (rising[-1] if len(rising) else 0) + 1
            opened = int(np.argmax(after < 0.01 * level)) if (after < 0.01 * level).any() else len(after)
            held = int(np.argmax(after < 0.99 * level))
            found.append(Blink((start + top) / HZ, float(level), closing / HZ, (opened - held) / HZ, len(tops) == 1))
    return found


def leaps_of(world: np.ndarray) -> list[Leap]:
    """Runs of frames in which the eyes are faster than 12 degrees a second: the way of each, and its time."""
    speed = np.hypot(*np.diff(world, axis=0).T) * HZ
    fast = np.flatnonzero(np.diff(np.concatenate([[0], speed > 12.0, [0]])))
    return [
        Leap(begin / HZ, world[end] - world[begin], (end - begin) / HZ)
        for begin, end in fast.reshape(-1, 2)
        if np.hypot(*(world[end] - world[begin])) > SEEN_DEG
    ]


def longer_than(size: np.ndarray, largest: float) -> np.ndarray:
    """How probable a leap beyond ``size`` degrees is among those that are seen, by the formula of Eyes Alive."""

    def beyond(degrees):
        return np.clip(15.7 * np.exp(-degrees / 6.9) - 15.7 * math.exp(-largest / 6.9), 0.0, None)

    return beyond(size) / beyond(SEEN_DEG)


@pytest.mark.slow
@pytest.mark.parametrize("state", STATES)
def test_the_lids_close_as_often_as_the_state_says(state):
    blinks, expected = seen(state)[0], 5.0 * TABLE.states[state].blinks_per_minute
    assert expected - 3.0 * math.sqrt(expected) < len(blinks) < expected + 3.0 * math.sqrt(expected)


@pytest.mark.slow
@pytest.mark.parametrize("state", STATES)
def test_lids_close_faster_than_they_open_and_most_close_whole(state):
    blinks = [each for each in seen(state)[0] if each.alone]  # a double's second one begins where the first opens
    closing, opening = (np.array([getattr(each, name) for each in blinks]) for name in ("closing_s", "opening_s"))
    assert (closing < opening).all()
    assert 1.5 < np.median(opening) / np.median(closing) < 3.0
    assert closing.max() < 0.1 + 2 / HZ
    assert opening.max() < 0.25 + 2 / HZ
    whole = np.array([each.depth for each in blinks]) > 0.99
    assert 0.7 < whole.mean() < 0.99
    assert min(each.depth for each in blinks) > 0.45


@pytest.mark.slow
def test_a_face_blinks_more_as_it_speaks_and_less_as_it_thinks():
    counts = {state: len(seen(state)[0]) for state in STATES}
    assert counts["speaking"] > counts["idle"] > counts["thinking"]


@pytest.mark.slow
@pytest.mark.parametrize("state", ["listening", "speaking"])
def test_the_eyes_leap_as_often_and_as_far_as_eyes_alive_says(state):
    leaps, row = seen(state)[1], TABLE.states[state]
    # of two stays, one at and one aside; leaps too small to be seen are told apart by the formula
    unseen = 1.0 - (15.7 * math.exp(-SEEN_DEG / 6.9) - 0.6) / (15.0 - 0.6)
    expected = FIVE_MINUTES / (0.5 * (row.at_s + row.away_s)) * (1.0 - unseen)
    assert abs(len(leaps) - expected) < 4.0 * math.sqrt(expected)
    sizes = np.array([each.size for each in leaps])
    assert sizes.max() < row.largest_deg + 0.6
    level = np.array([each.size for each in leaps if abs(each.way_deg[0]) > 2.4 * abs(each.way_deg[1])])
    order = np.sort(level)
    farther = 1.0 - np.arange(len(order)) / len(order)
    assert np.abs(farther - longer_than(order, row.largest_deg)).max() < 1.8 / math.sqrt(len(order) / 2)


@pytest.mark.slow
def test_a_leap_takes_25_ms_and_more_the_farther_it_goes():
    for each in seen("speaking")[1]:
        # the slow beginning and end of it are below the threshold of what is seen as fast
        assert 0.5 * (0.025 + 0.0024 * each.size) - 2 / HZ < each.seconds < 0.025 + 0.0024 * each.size + 2 / HZ


@pytest.mark.slow
def test_what_is_seen_stays_within_the_ellipse_and_everything_within_its_range():
    for state in STATES:
        _, leaps, low, high = seen(state)
        for each in leaps:
            assert np.hypot(each.way_deg[0] / 27.5, each.way_deg[1] / 12.0) < 1.06
        assert (low >= LOW).all()
        assert (high <= HIGH).all()
        moved = {name for name, least, most in zip(NAMES, low, high, strict=True) if least < most}
        assert {"pupil_dilation_l", "head_roll", "gaze_yaw", "nostril_flare_r"} <= moved


@pytest.mark.soak
@pytest.mark.parametrize("state", ["listening", "speaking"])
def test_an_hour_has_the_directions_the_stays_and_the_blinks_it_claims(state):
    blinks, leaps, low, high = seen(state, HOUR)
    assert len(blinks) == pytest.approx(60.0 * TABLE.states[state].blinks_per_minute, rel=0.1)
    away = leaps_aside(leaps)
    bins = np.array([round(math.degrees(math.atan2(*each.way_deg[::-1])) / 45.0) % 8 for each in away])
    found = np.bincount(bins, minlength=8) / len(bins)
    shares = np.array(list(TABLE.saccades.directions.values()))
    assert np.abs(found - shares / shares.sum()).max() < 4.0 * math.sqrt(0.2 * 0.8 / len(bins))
    assert (low >= LOW).all()
    assert (high <= HIGH).all()


def leaps_aside(leaps: list[Leap]) -> list[Leap]:
    """Of leaps that go aside and come back, those that go aside: they begin where the eyes were straight ahead."""
    found, at = [], np.zeros(2)
    for each in leaps:
        if np.hypot(*at) < SEEN_DEG:
            found.append(each)
        at = at + each.way_deg
    return found
