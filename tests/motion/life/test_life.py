"""A living face: still at 0, the same at any frame rate and from the same seed, and without a jump in any speed."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from agentface import Face
from agentface.emotion.inference import default_inference
from agentface.motion.eyesight import Eyesight
from agentface.motion.figures import STATES, default_life
from agentface.parameters import HIGH, LOW, NAMES, FacePose, parameter
from tests.heads import head_model
from tests.motion.living import channels, trace

TABLE = default_life()
PAIRS = [(known, NAMES.index(f"{known[:-2]}_r")) for known in NAMES if known.endswith("_l")]
SIGHT = Eyesight.of(head_model())


def test_a_face_that_is_told_nothing_is_perfectly_still():
    face = Face(head_model(), compiled=False)
    rest = face.step(0.0).vertices.copy()
    for state in (None, *STATES):
        face.set_state(state)
        face.channels.life.speaking(state == "idle")
        face.channels.life.beat(1.0, 0.1)
        face.channels.life.sentence_ends(0.2)
        for dt in (0.3, 2.0, 50.0):
            face.channels.advance(dt)
            assert face.channels.pose() == FacePose()
    np.testing.assert_array_equal(face.step(3.0).vertices, rest)


def test_a_still_face_does_what_it_is_told_bit_by_bit_as_one_that_lived_before():
    lived, still = channels(seed=5), channels(liveliness=0.0)
    trace(lived, 7.0, 30)
    lived.life.set_liveliness(0.0)
    poses = trace(lived, 2.0, 100)
    assert (poses[-1] == 0).all()
    shown = []
    for mixer in (lived, still):
        mixer.gaze.turn((0.2, 0.1, 0.0), 0.1)
        mixer.head.turn((0.3, 0.0, 0.1), 0.4)
        mixer.blink.blink()
        mixer.gestures.play("nod")
        shown.append(trace(mixer, 1.5, 60))
    np.testing.assert_allclose(shown[0], shown[1], atol=1e-9)


def test_the_dial_goes_down_slowly_and_up_again():
    mixer = channels(seed=2)
    trace(mixer, 20.0, 30)
    mixer.life.set_liveliness(0.0)
    way = trace(mixer, 1.5, 500)
    assert np.abs(np.diff(way[:, head_places()], axis=0)).max() * 500 < np.radians(12.0)
    assert not way[-1].any()
    mixer.life.set_liveliness(0.6)
    assert trace(mixer, 30.0, 30)[:, head_places()].std(0).min() > np.radians(0.1)


def test_a_livelier_face_moves_its_head_further():
    far = [trace(channels(seed=4, liveliness=dial), 60.0, 20)[:, head_places()].std(0) for dial in (0.2, 0.6, 1.0)]
    assert (far[0] < far[1]).all()
    assert (far[1] < far[2]).all()


def head_places():
    return [parameter(name).index for name in ("head_yaw", "head_pitch", "head_roll")]


def scripted(hz, seed=1):
    """A face that is told much, at times that all rates have; every sixth of a second."""
    mixer, poses = channels(seed=seed, rules=default_inference()), []
    told = {
        1: lambda: mixer.emotion.change({"happiness": 0.8}, 0.3, None),
        4: lambda: mixer.emotion.change({"happiness": 0.1, "surprise": 0.9}, None, 0.5),
        2: lambda: mixer.life.set_state("listening"),
        5: lambda: mixer.gaze.look_at(SIGHT, (0.4, 0.1, 0.5), 0.06),
        7: lambda: mixer.life.beat(1.0, 0.31),
        9: lambda: mixer.gestures.play("shake", 0.8),
        10: mixer.blink.blink,
        12: lambda: mixer.life.speaking(True, 0.123),
        13: lambda: mixer.life.set_state(None),
        14: lambda: mixer.life.sentence_ends(0.05),
        17: lambda: mixer.head.turn((-0.3, 0.1, 0.0), 0.4),
        19: lambda: mixer.gestures.play("wink"),
        20: lambda: mixer.gestures.play("wink"),
        22: lambda: mixer.release(0.3),
        26: lambda: mixer.life.set_liveliness(0.3),
        60: lambda: mixer.life.set_state("thinking"),
        90: lambda: mixer.life.set_liveliness(0.0),
    }
    for sixth in range(100):
        told.get(sixth, lambda: None)()
        trace(mixer, 1 / 6, hz)
        poses.append(mixer.pose().array)
    return np.array(poses)


@pytest.mark.untraced
def test_30_60_and_144_frames_a_second_show_the_same():
    slow = scripted(30)
    assert np.ptp(slow, axis=0)[head_places()].min() > 0.01
    for hz in (60, 144):
        assert np.abs(scripted(hz) - slow).max() < 1e-3


@pytest.mark.untraced
def test_frames_of_any_length_show_the_same():
    even, uneven = channels(seed=9, state="speaking"), channels(seed=9, state="speaking")
    draw = np.random.default_rng(0)
    for _ in range(200):
        steps = draw.dirichlet(np.ones(draw.integers(1, 6))) * 0.1
        for dt in steps:
            uneven.advance(float(dt))
            uneven.pose()
        even.advance(0.1)
        np.testing.assert_allclose(uneven.pose().array, even.pose().array, atol=1e-6)


def test_the_same_seed_lives_the_same_life_and_another_one_another():
    one, same, other = (trace(channels(seed=seed), 10.0, 30) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert np.abs(one - other).max() > 0.05
    face, twin = Face(head_model(), seed=3, liveliness=0.6), Face(head_model(), seed=3, liveliness=0.6)
    for _ in range(5):
        np.testing.assert_array_equal(face.step(0.21).vertices, twin.step(0.21).vertices)


@pytest.mark.untraced
@pytest.mark.parametrize("seed", range(4))
def test_the_sides_of_a_pair_are_never_in_exact_step_and_never_far_apart(seed):
    mixer = channels(seed=seed)
    for name in ("brow_flash", "frown", "mouth_shrug"):
        mixer.gestures.play(name)
    mixer.blink.blink()
    poses = trace(mixer, 2.0, 1000)
    moved = [(left, right) for left, right in PAIRS if poses[:, parameter(left).index].any()]
    assert len(moved) >= 8
    for left, right in moved:
        one, other = poses[:, parameter(left).index], poses[:, right]
        apart = np.abs(one - other)
        assert apart.max() > 0.0, left
        speed = np.abs(np.diff(one)).max() * 1000
        assert apart.max() <= 0.031 * speed + 1e-4, left


def shown_smile(liveliness, seed=4):
    mixer = channels(seed=seed, liveliness=liveliness, rules=default_inference())
    mixer.emotion.change({"happiness": 0.8}, 0.4, None)
    poses = trace(mixer, 0.7, 1000)
    return [poses[:, parameter(f"zygomaticus_major_{side}").index] for side in "lr"]


@pytest.mark.untraced
@pytest.mark.parametrize("seed", range(3))
def test_one_side_of_a_smile_is_late_by_up_to_30_ms_where_the_face_lives(seed):
    sides = shown_smile(0.6, seed)
    half = [int(np.argmax(side > 0.5 * side[-1])) for side in sides]
    assert 0 < abs(half[0] - half[1]) <= 31
    assert sides[0][-1] == pytest.approx(sides[1][-1], abs=1e-6)
    still = shown_smile(0.0, seed)
    np.testing.assert_array_equal(still[0], still[1])
    first = int(np.argmin(half))
    np.testing.assert_allclose(sides[first], still[0], atol=1e-6)


DEEDS = st.one_of(
    st.tuples(st.just("look"), st.floats(-0.8, 0.8), st.floats(-0.3, 0.3), st.floats(0.3, 1.5), st.floats(0.06, 0.4)),
    st.tuples(st.just("gaze"), st.floats(-0.5, 0.5), st.floats(-0.3, 0.3), st.floats(0.06, 0.4)),
    st.tuples(st.just("head"), st.floats(-0.5, 0.5), st.floats(-0.3, 0.3), st.floats(0.2, 0.6)),
    st.tuples(st.just("gesture"), st.sampled_from(("nod", "glance", "brow_flash", "wink")), st.floats(0, 1)),
    st.tuples(st.just("blink")),
    st.tuples(st.just("beat"), st.floats(0, 1), st.floats(0, 0.3)),
    st.tuples(st.just("sentence")),
    st.tuples(st.just("speak"), st.booleans()),
    st.tuples(st.just("state"), st.sampled_from((None, *STATES))),
    st.tuples(st.just("lively"), st.sampled_from((0.0, 0.3, 0.6, 1.0))),
    st.tuples(st.just("release"), st.floats(0.1, 0.5)),
)


TOLD = {
    "look": lambda mixer, x, y, z, fade: mixer.gaze.look_at(SIGHT, (x, y, z), fade),
    "gaze": lambda mixer, yaw, pitch, fade: mixer.gaze.turn((yaw, pitch, 0.0), fade),
    "head": lambda mixer, yaw, pitch, fade: mixer.head.turn((yaw, pitch, 0.0), fade),
    "gesture": lambda mixer, *values: mixer.gestures.play(*values),
    "blink": lambda mixer: mixer.blink.blink(),
    "beat": lambda mixer, *values: mixer.life.beat(*values),
    "sentence": lambda mixer: mixer.life.sentence_ends(),
    "speak": lambda mixer, speaks: mixer.life.speaking(speaks),
    "state": lambda mixer, state: mixer.life.set_state(state),
    "lively": lambda mixer, dial: mixer.life.set_liveliness(dial),
    "release": lambda mixer, fade: mixer.release(fade),
}


def jumps(poses, hz):
    """By how much each speed jumps, ``(N, COUNT)`` a second: what is left of the change of the speed over a step of
    the time when the step is halved is the jump, and what halves is the acceleration.
    """
    near = np.abs(poses[2:] - 2 * poses[1:-1] + poses[:-2]) * hz
    far = np.abs(poses[4:] - 2 * poses[2:-2] + poses[:-4]) * hz / 2
    return 2 * near[1:-1] - far


def test_a_jump_is_seen_as_one():
    times = np.arange(0, 1, 1 / 2000)[:, None]
    assert jumps(np.sin(40 * times), 2000).max() < 0.03
    assert jumps(np.abs(times - 0.5), 2000).max() == pytest.approx(2.0, rel=0.05)


@pytest.mark.untraced
@settings(max_examples=25)
@given(st.lists(st.tuples(DEEDS, st.floats(0.01, 0.5)), min_size=1, max_size=6), st.integers(0, 99))
def test_no_speed_jumps_whatever_interrupts_what(script, seed):
    hz, mixer = 2000, channels(seed=seed)
    poses = [trace(mixer, 0.1, hz)]
    for deed, seconds in script:
        TOLD[deed[0]](mixer, *deed[1:])
        poses.append(trace(mixer, seconds, hz))
    poses.append(trace(mixer, 0.3, hz))
    found = np.concatenate(poses)
    worst = jumps(found, hz).max(0)
    place = int(worst.argmax())
    assert worst[place] < 0.15, (NAMES[place], worst[place])
    assert (found >= LOW).all()
    assert (found <= HIGH).all()


def test_it_listens_with_nods_and_speaks_while_it_speaks():
    mixer = channels(seed=1)
    assert mixer.life.state == "idle"
    mixer.life.speaking(True, 0.2)
    trace(mixer, 0.1, 60)
    assert mixer.life.state == "idle"
    trace(mixer, 0.2, 60)
    assert mixer.life.state == "speaking"
    mixer.life.set_state("listening")
    assert mixer.life.state == "listening"
    nods = set()
    for _ in range(60 * 60):
        mixer.advance(1 / 60)
        nods |= set(mixer.gestures.playing)
    assert nods == {"listening_nod"}
    mixer.life.set_state(None)
    mixer.life.speaking(False)
    trace(mixer, 0.1, 60)
    assert mixer.life.state == "idle"


def test_a_beat_is_lowest_at_the_stress_and_a_second_too_soon_is_left_out():
    mixer = channels(liveliness=0.6)
    mixer.life.beat(1.0, 1.0)
    mixer.life.beat(1.0, 1.2)
    mixer.life.beat(1.0, 2.0)
    lows = []
    for frame in range(300):
        mixer.advance(1 / 100)
        mixer.pose()
        lows.append(mixer.gestures.head[1])
        assert len(mixer.gestures.playing) <= 1, frame
    first, second = np.argmin(lows[:140]) / 100, 1.4 + np.argmin(lows[140:]) / 100
    assert [first, second] == pytest.approx([1.0, 2.0], abs=0.02)


def test_a_sentence_s_end_is_often_blinked_at():
    blinked = 0
    for seed in range(60):
        mixer = channels(seed=seed, state="thinking")
        mixer.life.sentence_ends(0.2)
        poses = trace(mixer, 0.4, 60)
        blinked += bool(poses[12:, parameter("orbicularis_oculi_palpebralis_l").index].any())
    assert 18 <= blinked <= 45
