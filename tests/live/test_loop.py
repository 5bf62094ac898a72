from __future__ import annotations

import threading

import numpy as np
import pytest

from agentface import Face
from agentface.clock import FrameClock
from agentface.emotion.inference import default_inference
from agentface.errors import InvalidValueError
from agentface.live.loop import run
from agentface.motion.emotion import EmotionChannel
from tests.clocks import ManualClock
from tests.heads import head_model


@pytest.fixture
def face():
    return Face(head_model())


def risen(seconds):
    """How happy a face is that was told to be happy within a second, so long after."""
    channel = EmotionChannel(default_inference())
    channel.change({"happiness": 1.0}, 1.0, None)
    channel.advance(seconds)
    return channel.intensities[0]


class Frames:
    """A sink that keeps what it is shown, and, on its clock, takes time for it."""

    def __init__(self, clock=None, takes_s=0.0):
        self.seen, self._clock, self._takes_s = [], clock, takes_s

    def show(self, frame):
        self.seen.append(frame.copy())
        if self._clock is not None:
            self._clock.sleep(self._takes_s)

    @property
    def times(self):
        return [frame.time_s for frame in self.seen]


class Told:
    """A source that asks ``what`` once, when ``time_s`` comes."""

    def __init__(self, time_s=np.inf, what=None):
        self.time_s, self.what, self.asked = time_s, what, [-1.0]

    def take_in(self, time_s):
        self.asked.append(time_s)
        if time_s >= self.time_s > self.asked[-2]:
            self.what()


def test_frames_fall_on_a_grid(face):
    frames, source = Frames(), Told()
    assert run(face, ManualClock(7.0), [source], [frames], fps=20, duration=1.0) == 20
    assert frames.times == pytest.approx([frame / 20 for frame in range(20)])
    assert source.asked[1:] == pytest.approx([0.0, *frames.times[:-1]]), "the beginnings of the steps"


def test_a_slow_sink_of_a_live_loop_gets_fewer_frames_and_the_face_keeps_the_time(face):
    clock = ManualClock()
    frames = Frames(clock, 0.12)
    face.set_emotion("joy", 1.0, fade=1.0)
    run(face, clock, [], [frames], fps=20, duration=0.55)
    assert frames.times == pytest.approx([0.0, 0.15, 0.3, 0.45])
    assert face.status()["shown"]["emotion"]["happiness"] == pytest.approx(risen(0.45), abs=1e-4)


def test_without_real_time_every_sink_gets_every_frame(face):
    first, second = Frames(), Frames()
    face.set_emotion("joy", 1.0, fade=0.5)
    assert run(face, FrameClock(30), [], [first, second], fps=30, duration=0.55) == 17
    assert first.times == second.times == [frame / 30 for frame in range(17)]
    np.testing.assert_array_equal(first.seen[-1].geometry.vertices, second.seen[-1].geometry.vertices)
    assert (first.seen[5].geometry.vertices != first.seen[6].geometry.vertices).any(), "copies hold"
    assert first.seen[16].pose["zygomaticus_major_l"] > first.seen[3].pose["zygomaticus_major_l"] > 0.0


def test_what_is_asked_moves_the_step_that_begins_then(face):
    frames = Frames()
    source = Told(0.2, lambda: face.set_emotion("joy", 1.0, fade=0.0))
    run(face, FrameClock(10), [source], [frames], fps=10, duration=0.45)
    levels = [frame.pose["zygomaticus_major_l"] for frame in frames.seen]
    assert levels[:3] == [0.0] * 3
    assert min(levels[3:]) > 0.5, "asked at 0.2 s, where the step to 0.3 s begins"


def test_no_step_is_longer_than_allowed(face):
    clock = ManualClock()
    face.set_emotion("joy", 1.0, fade=1.0)
    run(face, clock, [], [Frames(clock, 0.5)], fps=20, duration=0.6, longest_step_s=0.1)
    assert face.status()["shown"]["emotion"]["happiness"] == pytest.approx(risen(0.1), abs=1e-4)


def test_it_stops_when_told(face):
    frames = Frames()
    assert run(face, ManualClock(), [], [frames], stopped=lambda: len(frames.seen) == 3) == 3


def test_the_face_is_held_while_it_is_stepped_and_not_while_it_is_shown(face):
    lock, free = threading.Lock(), []

    class Looks:
        def __init__(self):
            self.times = 0

        def show(self, frame):
            free.append(not lock.locked())

        def take_in(self, time_s):
            free.append(lock.locked())

    run(face, FrameClock(10), [Looks()], [Looks()], fps=10, duration=0.15, held=lock)
    assert free == [True] * 4


@pytest.mark.parametrize("fps", [0.0, -1.0, float("nan"), 1e9])
def test_rates_that_are_none(face, fps):
    with pytest.raises(InvalidValueError, match="fps"):
        run(face, ManualClock(), fps=fps)
    with pytest.raises(InvalidValueError, match="fps"):
        FrameClock(fps)
