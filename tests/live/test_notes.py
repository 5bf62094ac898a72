"""What is filmed later is what was seen: a face stepped again from what the first one was asked."""

from __future__ import annotations

import numpy as np
import pytest

from agentface import Face
from agentface.clock import FrameClock
from agentface.deform.geometry import FaceArrays
from agentface.io.osc.receiver import Receiver
from agentface.live.loop import run
from agentface.live.notes import Recorder, Replay
from tests.clocks import ManualClock
from tests.heads import head_model
from tests.io.osc_bytes import message

FPS = 16  # of which a clock counts the seconds exactly
STORY = {
    0: [("emotion", "sf", "joy", 0.8), ("blink", "")],
    3: [("emotions", "sfsf", "fear", 0.5, "sad", 0.5), ("gaze", "fff", 20.0, -5.0, 0.1)],
    4: [("muscle", "sf", "risorius_l", 0.7), ("muscle", "sf", "jaw_open", 0.4), ("head", "fff", 10.0, 5.0, -5.0)],
    8: [("look_at", "fff", 0.05, 0.0, 0.4), ("look_at", "fff", 0.0, 0.0, -1.0)],  # the second is refused
    11: [("emotion", "sfff", "anger", 1.0, 0.2, 0.1)],
    20: [("neutral", "f", 0.3), ("blink", "")],
}


class Datagrams:
    """OSC messages at the numbers of their frames."""

    def __init__(self, face, clock, story):
        self.receiver, self.story, self.frame = Receiver(face, lambda *_: None, clock), story, 0

    def take_in(self, time_s):
        told = [message(f"/agentface/{name}", tags, *values) for name, tags, *values in self.story.get(self.frame, ())]
        self.frame += 1
        self.receiver.take([(packet, ("127.0.0.1", 1)) for packet in told])


class Seen:
    def __init__(self):
        self.frames = []

    def show(self, frame):
        self.frames.append(frame.copy())


@pytest.fixture(scope="module")
def model():
    return head_model()


def record(face, clock, **options):
    seen = Seen()
    with Recorder(face) as recorder:
        run(face, clock, [Datagrams(face, clock, STORY)], [recorder, seen], fps=FPS, **options)
    assert not face.noted
    return recorder, seen.frames


def replay(face, recorder):
    seen, end = Seen(), (round(recorder.last_s * FPS) + 0.5) / FPS
    run(face, FrameClock(FPS), [Replay(face, recorder.notes, FPS)], [seen], fps=FPS, duration=end)
    return seen.frames


def assert_the_same(frame, other):
    assert frame.pose == other.pose
    for name in FaceArrays._fields:
        np.testing.assert_array_equal(getattr(frame.geometry, name), getattr(other.geometry, name), err_msg=name)


def test_a_second_face_shows_every_frame_that_the_first_one_showed(model):
    recorder, lived = record(Face(model), ManualClock(100.0), duration=2.0)
    filmed = replay(Face(model), recorder)
    assert [frame.time_s for frame in filmed] == [frame.time_s for frame in lived] == [k / FPS for k in range(2 * FPS)]
    for frame, other in zip(filmed, lived, strict=True):
        assert_the_same(frame, other)
    assert len({float(frame.geometry.vertices.sum()) for frame in filmed}) >= FPS, "and they move"


class Late(ManualClock):
    """A clock of a machine that wakes up late, by up to a third of a frame."""

    def __init__(self, seed):
        super().__init__()
        self.random = np.random.default_rng(seed)

    def sleep(self, seconds):
        super().sleep(seconds + self.random.uniform(0.0, 0.33 / FPS))


@pytest.mark.parametrize("seed", range(3))
def test_a_machine_that_is_late_asks_the_same_at_the_same_frames(model, seed):
    recorder, lived = record(Face(model), Late(seed), duration=2.0)
    filmed = replay(Face(model), recorder)
    assert len(filmed) == len(lived)
    for frame, other in zip(filmed, lived, strict=True):
        assert frame.time_s == pytest.approx(other.time_s, abs=0.34 / FPS)
        off = np.abs(frame.geometry.vertices - other.geometry.vertices).max()
        assert off < 0.006, "as far as the face moves in a third of a frame"
    assert_the_same(filmed[0], lived[0])


def test_frames_that_were_missed_are_there(model):
    class Busy(ManualClock):
        def sleep(self, seconds):
            super().sleep(max(seconds, 5.5 / FPS if 0.4 < self.now() < 0.5 else 0.0))

    recorder, lived = record(Face(model), Busy(), duration=2.0)
    filmed = replay(Face(model), recorder)
    assert len(lived) < len(filmed) == 2 * FPS
    assert [frame.time_s for frame in filmed] == [k / FPS for k in range(2 * FPS)]


def test_nothing_was_recorded(model):
    recorder, lived = record(Face(model), ManualClock(), stopped=lambda: True)
    assert (recorder.last_s, recorder.notes, lived) == (None, [], [])
