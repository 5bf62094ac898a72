from __future__ import annotations

import threading

import pytest

from agentface import Face
from agentface.clock import SystemClock
from agentface.live.background import Background
from tests.heads import head_model
from tests.waiting import until


@pytest.fixture
def face():
    face = Face(head_model())
    face.warm_up()
    return face


class Counts:
    """A source that counts how often it was asked, and can fail."""

    def __init__(self):
        self.asked, self.fails, self.threads = 0, False, set()

    def take_in(self, time_s):
        self.asked += 1
        self.threads.add(threading.current_thread())
        if self.fails:
            raise OSError("the source is gone")


def test_every_frame_is_made_when_it_is_asked_for(face):
    with Background(face, SystemClock(), [], threading.RLock()) as loop:
        frames = [loop.frame(60.0) for _ in range(20)]
        assert loop.running
    times = [frame.time_s for frame in frames]
    assert times == sorted(set(times))
    assert not loop.running


def test_the_face_goes_on_while_nobody_takes_its_frames(face):
    counts = Counts()
    face.set_emotion("joy", 1.0, fade=0.1)
    with Background(face, SystemClock(), [counts], threading.RLock()) as loop:
        until(lambda: counts.asked > 10)
        assert loop.dropped >= 8
        frame = loop.frame(60.0)
        assert frame.pose["zygomaticus_major_l"] > 0.5, "it is there by now"
    assert counts.threads
    assert threading.current_thread() not in counts.threads


def test_the_face_waits_for_who_holds_it(face):
    counts, held = Counts(), threading.RLock()
    with Background(face, SystemClock(), [counts], held) as loop:
        loop.frame(60.0)
        with held:
            before = counts.asked
            frames = [loop.frame(0.1) for _ in range(4)]
            assert counts.asked == before
        assert sum(frame is not None for frame in frames) <= 2, "what was there already, and what was on its way"
        assert loop.frame(60.0) is not None


def test_it_ends_by_itself_and_with_its_source(face):
    with Background(face, SystemClock(), [], threading.RLock(), duration=0.05) as loop:
        until(lambda: not loop.running)
        while loop.frame(0.0) is not None:
            pass

    def fails(*, while_asked):
        counts = Counts()
        with Background(face, SystemClock(), [counts], threading.RLock()) as loop:
            loop.frame(60.0)
            counts.fails = True
            until(lambda: not loop.running)
            if while_asked:
                loop.frame(0.0)
                raise AssertionError("not reached")

    for while_asked in (True, False):
        with pytest.raises(OSError, match="the source is gone"):
            fails(while_asked=while_asked)
