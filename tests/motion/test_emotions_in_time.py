"""Emotions that come and go, each at its own pace, over a mood: smooth whatever interrupts what, and on time."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from scipy.interpolate import BSpline, CubicHermiteSpline

from agentface.emotion.envelopes import default_envelopes
from agentface.emotion.inference import default_inference
from agentface.emotion.ramps import KNOTS, exponential_onset
from agentface.emotion.state import EMOTIONS, EmotionState
from agentface.motion.course import LAG_S, TICK_S
from agentface.motion.emotion import EmotionChannel
from agentface.motion.mixer import Mixer
from agentface.parameters import MUSCLES, NAMES, indices_of

RIGHT = [NAMES[indices_of(muscle)[-1]] for muscle in MUSCLES]
STATES = st.dictionaries(st.sampled_from(EMOTIONS), st.floats(0, 1), max_size=4).map(EmotionState.of)
FADES = st.none() | st.floats(0.05, 2.0)
WAITS = st.floats(0.0, 0.7)
HOLDS = st.none() | st.just("own") | st.floats(0.0, 0.5)


def messages(fades=FADES):
    return st.one_of(
        st.tuples(
            st.just("change"), st.dictionaries(st.sampled_from(EMOTIONS), st.floats(0, 1), max_size=2), fades, HOLDS
        ),
        st.tuples(st.just("change"), STATES, fades, HOLDS),
        st.tuples(st.just("change_mood"), STATES, fades),
        st.tuples(st.just("release"), fades),
    )


def scripts(fades=FADES, waits=WAITS):
    return st.lists(st.tuples(messages(fades), waits), min_size=1, max_size=6)


def tell(channel, message):
    getattr(channel, message[0])(*message[1:])


def contractions(channel):
    """``(len(MUSCLES),)``, as they are written."""
    values = np.zeros(len(channel.names))
    channel.write(values, np.ones(len(channel.names)))
    return values[[channel.names.index(name) for name in RIGHT]]


def channel_of(**options):
    return EmotionChannel(default_inference(), **options)


def run(channel, seconds, dt):
    rows = []
    for _ in range(round(seconds / dt)):
        channel.advance(dt)
        rows.append(contractions(channel))
    return np.array(rows).reshape(-1, len(MUSCLES))


@pytest.mark.untraced
@given(scripts())
def test_no_message_makes_a_speed_jump(script):
    # Over a hundred-thousandth of a second a speed can hardly change: 0.1 a second is a thousandth of the fastest.
    channel, dt = channel_of(), 1e-5
    for message, seconds in script:
        before = run(channel, 3 * dt, dt)
        tell(channel, message)
        speeds = np.diff(np.concatenate([before, run(channel, 3 * dt, dt)]), axis=0) / dt
        assert np.abs(np.diff(speeds, axis=0)).max() < 0.1
        channel.advance(seconds)


OTHERS = st.one_of(
    messages().map(lambda told: lambda mixer: tell(mixer.emotion, told)),
    st.builds(
        lambda name, value, fade: lambda mixer: mixer.muscles.set(name, value, fade),
        st.sampled_from(MUSCLES),
        st.floats(0, 1),
        st.floats(0.05, 1.0),
    ),
    st.builds(lambda fade: lambda mixer: mixer.muscles.release(fade), st.floats(0.05, 1.0)),
    st.builds(
        lambda angle, fade: lambda mixer: mixer.head.turn((angle, -angle, 0.0), fade), *[st.floats(0.05, 0.7)] * 2
    ),
    st.builds(lambda fade: lambda mixer: mixer.release(fade), st.floats(0.05, 1.0)),
)


@pytest.mark.untraced
@given(st.lists(st.tuples(OTHERS, WAITS), min_size=1, max_size=6))
def test_no_message_makes_a_speed_of_any_parameter_jump(script):
    mixer, dt = Mixer(default_inference(), random=np.random.default_rng(0)), 1e-5
    for ask, seconds in script:
        poses = []
        for step in range(6):
            if step == 3:
                ask(mixer)
            mixer.advance(dt)
            poses.append(mixer.pose().array.astype(np.float64))
        speeds = np.diff(np.array(poses), axis=0) / dt  # of single precision: within 0.01
        assert np.abs(np.diff(speeds, axis=0)).max() < 0.2
        mixer.advance(seconds)


@pytest.mark.slow
@pytest.mark.untraced
@settings(max_examples=30)
@given(scripts(st.none() | st.floats(0.2, 2.0), st.floats(0.0, 0.3)))
def test_speeds_change_no_faster_than_those_of_a_quick_movement(script):
    # A minimum-jerk movement of a twentieth of a second changes its speed by 2300 a second within a second.
    channel, shown = channel_of(), []
    for message, seconds in script:
        tell(channel, message)
        shown.append(run(channel, max(seconds, 0.002), 1e-3))
    path = np.concatenate(shown)
    assert path.min() >= 0.0
    assert path.max() <= 1.0 + 1e-12
    assert np.abs(np.diff(path, 2, axis=0)).max(initial=0.0) / 1e-6 < 2300.0


@pytest.mark.untraced
@settings(max_examples=25)
@given(scripts(waits=st.integers(0, 4).map(lambda sixths: sixths / 6.0)))
def test_frames_at_any_rate_agree_at_common_times(script):
    paths = []
    for rate in (30, 60, 144):
        channel, rows = channel_of(), []
        for message, seconds in script:
            tell(channel, message)
            rows.append(run(channel, seconds, 1.0 / rate)[rate // 6 - 1 :: rate // 6])
        rows.append(run(channel, 2.0, 1.0 / rate)[rate // 6 - 1 :: rate // 6])
        paths.append(np.concatenate(rows))
    for path in paths[1:]:
        np.testing.assert_allclose(path, paths[0], atol=1e-6)


@given(scripts(), STATES, st.floats(LAG_S + 1e-3, 1.0))
def test_a_fade_that_is_told_is_kept_whatever_came_before(script, state, fade):
    channel = channel_of()
    for message, seconds in script:
        tell(channel, message)
        channel.advance(seconds)
    channel.change(state, fade, None)
    channel.advance(fade + 1e-9)
    np.testing.assert_array_equal(contractions(channel), default_inference().contractions(state))
    assert channel.target == state
    shown = contractions(channel)
    channel.advance(10.0)
    np.testing.assert_array_equal(contractions(channel), shown)


@given(scripts(), STATES)
@example([(("change", {"surprise": 1.0}, None, None), 0.1875)], EmotionState.of(surprise=1.0))
@example(
    [(("change", {"happiness": 1.0}, 0.0, None), 0.1), (("change", EmotionState.of(sadness=0.5), 0.5, None), 0.375)],
    EmotionState.of(sadness=0.5),
)
def test_no_fade_is_at_once(script, state):
    channel = channel_of()
    for message, seconds in script:
        tell(channel, message)
        channel.advance(seconds)
    channel.change(state, 0.0, None)
    for _ in range(2):
        np.testing.assert_array_equal(contractions(channel), default_inference().contractions(state))
        np.testing.assert_array_equal(channel.intensities, state.array)
        channel.advance(0.3)


@settings(max_examples=15, deadline=None)
@given(scripts(st.just(0.0) | FADES))
def test_numpy_does_what_the_kernels_do(script):
    plain, compiled = EmotionChannel(default_inference(compiled=False)), channel_of()
    for message, seconds in script:
        for channel in (plain, compiled):
            tell(channel, message)
        for dt in (0.0, 0.3 * seconds, 0.7 * seconds):
            plain.advance(dt)
            compiled.advance(dt)
            np.testing.assert_allclose(plain.intensities, compiled.intensities, atol=1e-9)
            np.testing.assert_allclose(contractions(plain), contractions(compiled), atol=1e-9)


@pytest.mark.parametrize("emotion", EMOTIONS)
def test_an_onset_is_what_the_rules_make_of_its_ramp(emotion):
    onset = default_envelopes().onset_s[EMOTIONS.index(emotion)]
    ramp = CubicHermiteSpline(np.linspace(0.0, 1.0, KNOTS), *exponential_onset().T)
    ticks = TICK_S * np.arange(-5.0, 130.0)
    levels = 0.8 * ramp(np.clip(ticks / (onset - LAG_S), 0.0, 1.0))
    asked = np.array([default_inference().contractions({emotion: level}) for level in levels])
    mean = (asked[2:] + asked[1:-1] + asked[:-2]) / 3.0
    knots = ticks[2] + TICK_S * np.arange(len(mean) + 3.0)
    expected = BSpline(knots, mean, 2)
    channel = channel_of()
    channel.change({emotion: 0.8}, None, None)
    for time in np.arange(1, 100) * 0.01:
        channel.advance(0.01)
        np.testing.assert_allclose(contractions(channel), expected(time), atol=1e-9)
        assert channel.intensities[EMOTIONS.index(emotion)] == pytest.approx(
            0.8 * ramp(min(time / (onset - LAG_S), 1.0)), abs=1e-9
        )


def test_a_new_emotion_leaves_a_longer_fade_of_another_as_it_is():
    alone, beside = channel_of(), channel_of()
    for channel in (alone, beside):
        channel.change({"happiness": 1.0}, 5.0, None)
        channel.advance(1.0)
    beside.change({"surprise": 1.0}, 0.1, None)
    for _ in range(39):
        alone.advance(0.1)
        beside.advance(0.1)
        assert beside.intensities[0] == alone.intensities[0]
        assert beside.intensities[-1] == 1.0
    assert 0.5 < alone.intensities[0] < 1.0


def test_surprise_is_there_before_sadness_and_goes_before_it():
    channel = channel_of()
    channel.change({"surprise": 1.0, "sadness": 1.0}, None, None)
    channel.advance(0.2)
    assert channel.intensities[EMOTIONS.index("surprise")] == 1.0
    assert channel.intensities[EMOTIONS.index("sadness")] < 0.3
    channel.advance(2.0)
    channel.release(None)
    channel.advance(0.6)
    assert channel.intensities[EMOTIONS.index("surprise")] == 0.0
    assert channel.intensities[EMOTIONS.index("sadness")] > 0.4


def test_an_emotion_in_its_own_time_stays_for_its_apex():
    channel, envelopes = channel_of(), default_envelopes()
    place = EMOTIONS.index("fear")
    channel.change({"fear": 0.9}, None, "own")
    channel.advance(envelopes.onset_s[place] + envelopes.apex_s[place] - 1e-6)
    assert channel.target["fear"] == channel.intensities[place] == 0.9
    channel.advance(2e-6)
    assert channel.target["fear"] == 0.0
    channel.advance(envelopes.offset_s[place])
    assert not contractions(channel).any()


class TestMood:
    def test_brief_expressions_return_to_it(self):
        channel, mood = channel_of(), EmotionState.of(happiness=0.4)
        channel.change_mood(mood)
        channel.advance(default_envelopes().mood_s)
        np.testing.assert_array_equal(contractions(channel), default_inference().contractions(mood))
        channel.change({"happiness": 0.0, "disgust": 0.9}, 0.2, 0.5)
        channel.advance(0.3)
        assert channel.target == EmotionState.of(disgust=0.9)
        channel.advance(1.0)
        assert channel.target == mood
        np.testing.assert_array_equal(contractions(channel), default_inference().contractions(mood))

    def test_an_expression_that_is_shown_stays_until_it_is_let_go_of(self):
        channel = channel_of()
        channel.change({"anger": 0.8}, 0.0, None)
        channel.change_mood(EmotionState.of(anger=0.1, happiness=0.3), 0.0)
        assert channel.target == EmotionState.of(anger=0.8, happiness=0.3)
        channel.release(0.0)
        assert channel.target == EmotionState.of(anger=0.1, happiness=0.3)
        channel.change_mood(EmotionState(), 0.0)
        assert channel.target == EmotionState()
        assert not contractions(channel).any()

    @given(scripts(), STATES, st.integers(1, 30), st.floats(0.05, 0.5))
    def test_neutral_returns_to_it_however_often_it_is_sent(self, script, mood, times, fade):
        channel = channel_of()
        for message, seconds in script:
            tell(channel, message)
            channel.advance(seconds)
        channel.change_mood(mood, 0.3)
        for _ in range(times):
            channel.release(fade)
            channel.advance(fade / times)
        channel.advance(0.3)
        assert channel.target == channel.mood == mood
        np.testing.assert_array_equal(contractions(channel), default_inference().contractions(mood))


@pytest.mark.untraced
@given(st.integers(1, 60), st.floats(0.06, 0.4))
def test_repeating_a_message_holds_nothing_back(times, fade):
    once, often = channel_of(), channel_of()
    once.change({"fear": 0.7}, fade, None)
    for _ in range(times):
        often.change({"fear": 0.7}, fade, None)
        for channel in (once, often):
            channel.advance(fade / times)
    np.testing.assert_array_equal(contractions(often), contractions(once))


def test_a_long_time_at_once_ends_where_frames_end():
    frames, whole = channel_of(), channel_of()
    for channel in (frames, whole):
        channel.change({"anger": 0.9}, None, 0.5)
        channel.change_mood(EmotionState.of(sadness=0.2))
    for _ in range(300):
        frames.advance(0.1)
    whole.advance(30.0)
    np.testing.assert_array_equal(contractions(whole), contractions(frames))
    assert math.isclose(float(whole.intensities[1]), 0.2)
