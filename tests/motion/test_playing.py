"""A performance on the mixer: exact where nothing else is asked, smooth wherever it begins, ends or is replaced."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.clock import FrameClock
from agentface.emotion.inference import default_inference
from agentface.errors import InvalidValueError
from agentface.live.loop import run
from agentface.live.performances import PerformancePlayer
from agentface.motion.mixer import Mixer
from agentface.motion.performance import HOLD_S, LET_GO_S, Performance
from agentface.motion.playing import PerformanceChannel
from agentface.parameters import COUNT, HIGH, LOW, NAMES, NEUTRAL, parameter
from agentface.requests import Play

SMILE, YAW = parameter("zygomaticus_major_l").index, parameter("head_yaw").index


def moving(values, rate=25.0, only=None):
    """A performance of the numbers 0..1, spread over the range of every parameter or of some."""
    poses = (LOW + np.asarray(values, np.float32)[:, None] * (HIGH - LOW)).clip(LOW, HIGH)
    weights = np.zeros((1, COUNT), np.float32)
    weights[:, slice(None) if only is None else only] = 1.0
    return Performance.regular(rate, np.where(weights > 0, poses, NEUTRAL), weights)


@pytest.fixture(scope="module")
def rules():
    return default_inference()


@pytest.mark.parametrize("rate", [10.0, 25.0, 30.0, 60.0, 240.0])
@pytest.mark.parametrize("shown_at", [1, 2, 4])
def test_every_frame_of_the_file_is_shown_exactly(rules, rate, shown_at):
    played = moving(np.random.default_rng(0).uniform(size=12), rate)
    mixer = Mixer(rules)
    mixer.emotion.change({"anger": 1.0}, 0.0, None)
    mixer.performance.play(played)
    for frame, pose in enumerate(played.poses):
        np.testing.assert_array_equal(mixer.pose().array, pose, err_msg=f"frame {frame}")
        for _ in range(shown_at):
            mixer.advance(1 / rate / shown_at)


def test_it_wins_over_emotions_and_gaze_and_loses_to_the_hand(rules):
    mixer = Mixer(rules)
    mixer.emotion.change({"happiness": 1.0}, 0.0, None)
    mixer.head.turn_one("head_yaw", 0.5, 0.0)
    mixer.muscles.set("jaw_open", 0.25, 0.0)
    felt = mixer.pose()
    mixer.performance.play(moving([0.5, 0.5], only=[SMILE, YAW, parameter("jaw_open").index]))
    shown = mixer.pose()
    assert shown["zygomaticus_major_l"] == 0.5
    assert shown["head_yaw"] == 0.0
    assert shown["jaw_open"] == 0.25
    others = [name for name in NAMES if name not in ("zygomaticus_major_l", "head_yaw")]
    assert [shown[name] for name in others] == [felt[name] for name in others]


def test_a_blink_closes_the_lids_of_a_performance(rules):
    mixer = Mixer(rules)
    mixer.performance.play(moving([0.0] * 50))
    mixer.blink.blink()
    mixer.advance(0.09)
    assert mixer.pose()["orbicularis_oculi_palpebralis_l"] == 1.0


def test_after_the_end_it_lets_go_of_everything(rules):
    mixer = Mixer(rules)
    mixer.emotion.change({"happiness": 1.0}, 0.0, None)
    felt = mixer.pose()
    played = moving([0.2, 0.9, 0.4])
    mixer.performance.play(played)
    mixer.advance(played.duration_s)
    assert mixer.performance.playing
    assert mixer.pose() != felt
    mixer.advance(LET_GO_S + 1e-9)
    assert not mixer.performance.playing
    assert mixer.pose() == felt
    assert mixer.performance.time_s is None


def test_a_stream_that_stops_is_waited_for_and_then_lets_go(rules):
    mixer = Mixer(rules)
    values, weights = np.zeros(COUNT, np.float32), np.zeros(COUNT, np.float32)
    values[SMILE] = weights[SMILE] = 1.0
    for _ in range(30):
        mixer.performance.show(values, weights)
        mixer.advance(0.4 * HOLD_S)
        assert mixer.pose()["zygomaticus_major_l"] == 1.0
    mixer.advance(0.5 * HOLD_S)
    assert mixer.pose()["zygomaticus_major_l"] == 1.0
    mixer.advance(0.1 * HOLD_S + 0.5 * LET_GO_S)
    assert 0.4 < mixer.pose()["zygomaticus_major_l"] < 0.6
    mixer.advance(0.5 * LET_GO_S + 1e-9)
    assert mixer.pose()["zygomaticus_major_l"] == 0.0


DEEDS = st.lists(
    st.tuples(
        st.sampled_from(["play", "release", "show", "wait"]),
        st.lists(st.floats(0, 1), min_size=1, max_size=6),
        st.floats(0.1, 0.6),
        st.floats(0.0, 0.8),
    ),
    max_size=8,
)


@pytest.mark.untraced
@given(DEEDS)
def test_nothing_jumps_wherever_it_is_begun_replaced_or_stopped(deeds):
    mixer, dt = Mixer(default_inference()), 0.01
    span = (HIGH - LOW).astype(np.float64)
    before = mixer.pose().array / span
    for deed, values, fade, seconds in deeds:
        played = moving(values, rate=5.0, only=[SMILE, YAW])
        if deed == "play":
            mixer.performance.play(played, fade)
        elif deed == "show":
            mixer.performance.show(played.poses[0], played.weights[0], fade)
        elif deed == "release":
            mixer.performance.release(fade)
        np.testing.assert_allclose(mixer.pose().array / span, before, atol=1e-6, err_msg=deed)
        for _ in range(round(seconds / dt)):
            mixer.advance(dt)
            now = mixer.pose().array / span
            # a file's own fastest change, 1.5 of its range in 0.2 s, and that of a rest, 1.875 in 0.1 s, twice
            assert np.abs(now - before).max() <= (1.5 / 0.2 + 2 * 1.875 / 0.1 + 10.0) * dt
            before = now


def test_a_performance_replaced_in_full_motion_has_no_kink():
    mixer, dt = Mixer(default_inference()), 1e-3
    mixer.performance.play(moving(np.linspace(0, 1, 20), only=[SMILE]))
    speeds = []
    for step in range(700):
        if step == 300:
            mixer.performance.play(moving(np.linspace(1, 0, 20), only=[SMILE]), fade=0.3)
        before = mixer.performance._wanted[0, SMILE] + mixer.performance._rest.value[SMILE]
        mixer.advance(dt)
        speeds.append((mixer.performance._wanted[0, SMILE] + mixer.performance._rest.value[SMILE] - before) / dt)
    assert np.abs(np.diff(speeds[250:350])).max() < 0.5, "a jump of the speed would be 2.6 a second"


def test_a_gap_in_a_performance_ends_nothing(rules):
    weights = np.ones((4, COUNT), np.float32)
    weights[1:3] = 0.0
    poses = np.zeros((4, COUNT), np.float32)
    poses[:, SMILE] = 1.0
    mixer = Mixer(rules)
    mixer.performance.play(Performance([0, 1, 2, 3], poses, weights))
    mixer.advance(1.5)
    assert mixer.pose()["zygomaticus_major_l"] == 0.0
    assert mixer.performance.playing
    mixer.advance(1.5)
    assert mixer.pose()["zygomaticus_major_l"] == 1.0


def test_neutral_and_none_end_it(face_without_view):
    face = face_without_view
    for end in (lambda: face.neutral(fade=0.0), lambda: face.play(None)):
        face.play(moving([0.7] * 9, only=[SMILE]))
        assert face.pose["zygomaticus_major_l"] == pytest.approx(0.7)
        end()
        assert face.pose["zygomaticus_major_l"] == 0.0
    with pytest.raises(InvalidValueError, match="a Performance or None"):
        face.play("nod")
    with pytest.raises(InvalidValueError, match="fade"):
        face.play(None, fade=-1.0)


def test_the_loop_shows_a_frame_of_the_file_at_each_of_its_times(face_without_view):
    face, played = face_without_view, moving([0.1, 0.9, 0.3, 0.5], only=[SMILE])
    shown = Poses()
    run(face, FrameClock(50.0), [PerformancePlayer(face, played)], [shown], fps=50.0, duration=6.5 / 50)
    assert shown.poses[::2] == pytest.approx([0.1, 0.9, 0.3, 0.5])
    assert all(0.1 < between < 0.9 for between in shown.poses[1::2])


def test_again_and_again_it_comes_back_smoothly(face_without_view):
    face, played = face_without_view, moving(np.linspace(0, 1, 26), only=[SMILE])
    shown = Poses()
    run(face, FrameClock(100.0), [PerformancePlayer(face, played, again=True)], [shown], fps=100.0, duration=3.2)
    assert np.abs(np.diff(shown.poses)).max() < 0.08
    assert max(shown.poses[150:]) > 0.95
    assert min(shown.poses[150:]) < 0.6


def test_what_was_played_is_noted_and_can_be_asked_again(face_without_view):
    import pickle

    request = Play(moving([0.5, 0.6]), fade=0.1)
    again = pickle.loads(pickle.dumps(request))  # noqa: S301 - our own bytes
    assert again == request
    assert hash(again) == hash(request)
    assert request != Play(moving([0.5, 0.7]), fade=0.1)
    face_without_view.apply(again)
    assert face_without_view.channels.performance.playing


def test_an_idle_channel_costs_nothing_and_says_nothing():
    channel = PerformanceChannel()
    channel.advance(1.0)
    channel.release(0.1)
    assert channel.write(np.zeros(COUNT), np.ones(COUNT)) is False


class Poses:
    def __init__(self):
        self.poses = []

    def show(self, frame):
        self.poses.append(frame.pose["zygomaticus_major_l"])


@pytest.fixture
def face_without_view():
    from agentface.face import Face

    return Face("amber")
