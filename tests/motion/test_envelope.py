from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from agentface.motion.envelope import Envelope

fractions = st.floats(0, 1, width=32)
fades = st.floats(0.02, 1.0)
moves = st.lists(st.tuples(fractions, fades, st.floats(0.0, 1.5)), min_size=1, max_size=6)
STEP = 4e-3


def run(envelope: Envelope, seconds: float) -> np.ndarray:
    return np.array([envelope.advance(STEP)[0] for _ in range(round(seconds / STEP))])


@pytest.mark.slow
@pytest.mark.untraced
@given(moves)
def test_never_jumps_however_often_it_is_interrupted(plan):
    envelope = Envelope(1)
    shown = [np.zeros(1)]
    for target, fade, seconds in plan:
        envelope.move(target, fade)
        shown.append(run(envelope, min(seconds, fade)))
    path = np.concatenate(shown)
    assert path.min() >= 0.0
    assert path.max() <= 1.0
    # A whole move over the range has its top speed, 1.875 / fade, half-way; interruptions may at most double it.
    shortest = min(fade for _, fade, _ in plan)
    assert np.abs(np.diff(path)).max(initial=0.0) <= 2.0 * 1.875 / shortest * STEP


@given(moves)
def test_speed_is_continuous_through_interruptions(plan):
    envelope = Envelope(1)
    for target, fade, seconds in plan:
        before, value = envelope.velocity.copy(), envelope.value.copy()
        envelope.move(target, fade)
        np.testing.assert_array_equal(envelope.value, value)
        envelope.advance(1e-9)
        # Room to brake shrinks with the distance to the limit, and a value there has no speed to lose.
        np.testing.assert_allclose(envelope.velocity, before, atol=1e-2 * max(1.0, np.abs(before).max()))
        envelope.advance(seconds)


@given(moves, fractions, fades)
def test_ends_exactly_and_at_rest(plan, last, fade):
    envelope = Envelope(1)
    for target, each, seconds in plan:
        envelope.move(target, each)
        envelope.advance(seconds)
    envelope.move(last, fade)
    envelope.advance(fade + max(each for _, each, _ in plan))
    assert envelope.value[0] == last
    assert envelope.velocity[0] == 0.0
    assert envelope.settled


@given(fractions, fractions, st.floats(0.01, 5))
def test_an_undisturbed_move_is_the_minimum_jerk_path(first, second, fade):
    envelope = Envelope(1)
    envelope.move(first, 0.0)
    envelope.move(second, fade)
    for u in (0.2, 0.5, 0.9):
        direct = Envelope(1)
        direct.move(first, 0.0)
        direct.move(second, fade)
        share = np.polyval([6, -15, 10, 0, 0, 0], u)
        assert direct.advance(u * fade)[0] == pytest.approx(first + (second - first) * share, abs=1e-9)
    assert envelope.value[0] == first


@given(fractions, fades, st.lists(st.floats(1e-4, 0.3), min_size=1, max_size=20))
def test_frame_rate_does_not_change_the_motion(target, fade, frames):
    fine, coarse = Envelope(1), Envelope(1)
    for envelope in (fine, coarse):
        envelope.move(target, fade)
    for dt in frames:
        fine.advance(dt)
    coarse.advance(sum(frames))
    np.testing.assert_allclose(fine.value, coarse.value, atol=1e-9)


def test_velocity_is_the_derivative():
    envelope = Envelope(1)
    envelope.move(1.0, 0.5)
    envelope.advance(0.2)
    envelope.move(0.1, 0.7)
    for _ in range(600):
        before = envelope.value[0]
        speed = envelope.velocity[0]
        envelope.advance(1e-5)
        assert envelope.value[0] - before == pytest.approx(speed * 1e-5, abs=2e-8)
        envelope.advance(1e-3)


def test_repeating_a_message_does_not_hold_the_face_back():
    once, often = Envelope(1), Envelope(1)
    once.move(0.8, 0.25)
    for _ in range(60):
        often.move(0.8, 0.25)
        once.advance(1 / 60)
        often.advance(1 / 60)
        np.testing.assert_allclose(often.value, once.value, atol=1e-12)
    assert often.value[0] == 0.8


def test_a_shorter_fade_to_the_same_target_is_taken():
    envelope = Envelope(1)
    envelope.move(1.0, 10.0)
    envelope.advance(0.1)
    envelope.move(1.0, 0.1)
    envelope.advance(0.1)
    assert envelope.value[0] == 1.0


def test_values_move_each_in_its_own_time():
    envelope = Envelope(3)
    envelope.move([1.0, 0.5], 1.0, [0, 2])
    envelope.advance(0.5)
    envelope.move(1.0, 0.1, [1])
    envelope.advance(0.1)
    assert envelope.value[1] == 1.0
    assert 0.5 < envelope.value[0] < 1.0
    envelope.advance(0.4)
    np.testing.assert_array_equal(envelope.value, [1.0, 1.0, 0.5])


def test_no_fade_is_at_once():
    envelope = Envelope(2)
    envelope.move(0.7, 0.0)
    np.testing.assert_array_equal(envelope.value, [0.7, 0.7])
    assert envelope.settled


def test_a_turn_at_full_speed_overshoots_by_a_tenth_at_most():
    envelope = Envelope(1, -1.0, 1.0)
    envelope.move(-0.8, 0.0)
    envelope.move(0.8, 0.1)
    envelope.advance(0.05)
    assert envelope.velocity[0] > 25.0
    top = envelope.value[0]
    envelope.move(-0.8, 1.0)
    assert run(envelope, 1.0).max() <= top + 0.2


@given(st.lists(st.floats(1e-3, 0.1), min_size=1, max_size=30), fades)
def test_a_finished_move_leaves_nothing_behind(frames, fade):
    envelope = Envelope(1)
    for dt in frames:
        envelope.move(1.0, sum(frames))
        envelope.advance(dt)
    envelope.advance(sum(frames) * 1e-10)
    envelope.move(0.0, fade)
    assert abs(envelope.advance(fade / 1000)[0] - 1.0) < 1e-3


@given(st.lists(st.tuples(st.lists(fractions, min_size=3, max_size=3), fades, st.floats(0.0, 1.5)), max_size=6))
def test_the_kernel_equals_its_numpy_twin(plan):
    compiled, plain = (Envelope(3, -0.5, [1.0, 1.0, 0.8], compiled=how) for how in (True, False))
    for target, fade, seconds in plan:
        for envelope in (compiled, plain):
            places = [0, 1] if seconds > 1.0 else [0, 1, 2]
            envelope.move(target[: len(places)], fade, places)
            envelope.advance(seconds)
        np.testing.assert_allclose(compiled.value, plain.value, atol=1e-12)
        np.testing.assert_allclose(compiled.velocity, plain.velocity, atol=1e-9)
        assert (compiled.settled, compiled.resting) == (plain.settled, plain.resting)
